// What to ask the server for: by whether the camera moves, and by how long a whole mesh takes to come.
import type { Wishes } from './session_watch';

export type Quality = 'full' | 'light' | 'coarse';

/** A still camera is owed the full mesh within half a second. */
const stillSeconds = 0.5;
/** A moving one should see some ten frames a second. */
const movingSeconds = 0.1;

/** secondsPerFullMesh: what a whole mesh at full quality takes, or would take, on this link. */
export function chooseQuality(moving: boolean, secondsPerFullMesh: number): Quality {
  if (moving) return secondsPerFullMesh > movingSeconds ? 'coarse' : 'light';
  return secondsPerFullMesh > stillSeconds ? 'light' : 'full';
}

/** offsetBits: of the mesh as reconstructed; fewer bits than it has are smaller, more are not to be had. */
export function wishesOf(quality: Quality, offsetBits: number): Wishes {
  switch (quality) {
    case 'full':
      return {};
    case 'light':
      return { normalBits: 7, positionBits: Math.min(4, offsetBits) };
    case 'coarse':
      return { normalBits: 6, positionBits: Math.min(3, offsetBits), maxLevel: 2 };
  }
}
