// The place of a camera and its target, and the distance from another such place.
import type { Point } from './bounds';

/** World units. */
export interface CameraPlace {
  readonly position: Point;
  readonly target: Point;
}

/** But for rounding on the way through the scene's coordinates. */
export function samePlace(a: CameraPlace, b: CameraPlace): boolean {
  return apart(a, b) <= 1e-6 * lengthOf(a);
}

/** The way of position and target together. */
export function apart(a: CameraPlace, b: CameraPlace): number {
  return distanceOf(a.position, b.position) + distanceOf(a.target, b.target);
}

/** From the position to the target. */
export function lengthOf({ position, target }: CameraPlace): number {
  return distanceOf(position, target);
}

function distanceOf(p: Point, q: Point): number {
  return Math.hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}
