// What to ask the server for: by whether the camera moves, and by how long a whole mesh takes to come.
import type { Wishes } from './session_watch';

export type Quality = 'full' | 'light' | 'coarse';

/** A still camera is owed the full mesh within half a second. */
const stillSeconds = 0.5;
/** A moving one should see some ten frames a second. */
const movingSeconds = 0.1;
/** A quality is taken back only where it fits by this much, since every change costs a whole mesh. */
const margin = 0.7;

/** secondsPerFullMesh: what a whole mesh at full quality takes, or would take, on this link. before: the quality until now. */
export function chooseQuality(moving: boolean, secondsPerFullMesh: number, before: Quality): Quality {
  if (moving) return secondsPerFullMesh > (before === 'coarse' ? margin : 1) * movingSeconds ? 'coarse' : 'light';
  return secondsPerFullMesh > (before === 'full' ? 1 : margin) * stillSeconds ? 'light' : 'full';
}

/** Of an attribute, per component: a still picture tells more shades apart than there are colors, for the probe. */
const attributeBits: Record<Quality, number> = { full: 12, light: 8, coarse: 8 };

/**
 * offsetBits: of the mesh as reconstructed; fewer bits than it has are smaller, more are not to be had. attribute: what vertices are
 * to carry.
 */
export function wishesOf(quality: Quality, offsetBits: number, attribute?: string): Wishes {
  const wishes = meshWishes(quality, offsetBits);
  return attribute === undefined
    ? wishes
    : { ...wishes, attributes: [{ name: attribute, bits: attributeBits[quality] }] };
}

function meshWishes(quality: Quality, offsetBits: number): Wishes {
  switch (quality) {
    case 'full':
      return {};
    case 'light':
      return { normalBits: 7, positionBits: Math.min(4, offsetBits) };
    case 'coarse':
      return { normalBits: 6, positionBits: Math.min(3, offsetBits), maxLevel: 2 };
  }
}
