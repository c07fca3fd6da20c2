// A plane across an axis, on one side of which nothing is shown.
import { Plane } from 'three';
import type { Point } from './bounds';
import { alongAxis, axes, toScene, type Axis, type UpAxis } from './up_axis';

export interface Cut {
  readonly axis: Axis;
  /** On the axis, world units. */
  readonly at: number;
  /** Which side is taken away: what lies beyond the plane on the axis, or what lies before it. */
  readonly away: 'beyond' | 'before';
}

/** How far inside of what is kept the point lies, world units; negative for what is taken away. */
export function depthInKept(cut: Cut, point: Point): number {
  const beyond = point[axes.indexOf(cut.axis)]! - cut.at;
  return cut.away === 'beyond' ? -beyond : beyond;
}

/** In the scene; its normal points into what is kept. */
export function cutPlane(cut: Cut, origin: Point, up: UpAxis): Plane {
  const normal = toScene(alongAxis(cut.axis), [0, 0, 0], up).multiplyScalar(cut.away === 'beyond' ? -1 : 1);
  return new Plane(normal, depthInKept(cut, origin));
}

/** The side that is nearer to the camera is taken away, so that the cut can be seen. */
export function sideTowards(camera: Point, axis: Axis, at: number): Cut['away'] {
  return camera[axes.indexOf(axis)]! > at ? 'beyond' : 'before';
}
