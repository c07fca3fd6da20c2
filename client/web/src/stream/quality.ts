// The quality of the meshes to ask for: it depends on the movement of the camera and on the time that a whole mesh takes.
import type { WatchOptions } from './session_watch';

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

/** Bits of an attribute, per component: a still picture has more steps than there are colors, for the probe. */
const attributeBits: Record<Quality, number> = { full: 12, light: 8, coarse: 8 };

/**
 * offsetBits: of the mesh as reconstructed; fewer bits than it has are smaller, more are not to be had. attribute: the name of the
 * one that vertices are to carry.
 */
export function watchOptions(quality: Quality, offsetBits: number, attribute?: string): WatchOptions {
  const options = meshOptions(quality, offsetBits);
  return attribute === undefined
    ? options
    : { ...options, attributes: [{ name: attribute, bits: attributeBits[quality] }] };
}

function meshOptions(quality: Quality, offsetBits: number): WatchOptions {
  switch (quality) {
    case 'full':
      return {};
    case 'light':
      return { normalBits: 7, positionBits: Math.min(4, offsetBits) };
    case 'coarse':
      return { normalBits: 6, positionBits: Math.min(3, offsetBits), maxLevel: 2 };
  }
}
