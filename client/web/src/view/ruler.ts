// The distance between two points.
import type { Point } from './bounds';

export interface Measured {
  /** World units, as all. */
  readonly distance: number;
  /** Along each axis, from the first point to the second one. */
  readonly along: Point;
}

export function measure(from: Point, to: Point): Measured {
  const along: Point = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
  return { distance: Math.hypot(...along), along };
}
