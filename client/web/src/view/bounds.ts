// The box around what is shown, world units.
import type { Shown } from '../bricks/brick_store';
import { brickEdge } from '../bricks/frame';

export type Point = [number, number, number];

export interface WorldBox {
  readonly min: Point;
  readonly max: Point;
}

/** None for an empty mesh. */
export function worldBox({ frame, bricks }: Shown): WorldBox | undefined {
  const min: Point = [Infinity, Infinity, Infinity];
  const max: Point = [-Infinity, -Infinity, -Infinity];
  const edge = brickEdge(frame);
  const step = frame.cellSize / 2 ** frame.offsetBits;
  for (const { encoded, decoded } of bricks.values())
    for (let axis = 0; axis < 3; ++axis) {
      const low = encoded.place[axis]! * edge;
      min[axis] = Math.min(min[axis]!, low + decoded.bounds.min[axis]! * step);
      max[axis] = Math.max(max[axis]!, low + decoded.bounds.max[axis]! * step);
    }
  return min[0] <= max[0] ? { min, max } : undefined;
}

export function center({ min, max }: WorldBox): Point {
  return [(min[0] + max[0]) / 2, (min[1] + max[1]) / 2, (min[2] + max[2]) / 2];
}

/** One box around the boxes that are there. */
export function unionOf(boxes: readonly (WorldBox | undefined)[]): WorldBox | undefined {
  return boxes.reduce((all, box) => (all && box ? union(all, box) : (all ?? box)), undefined);
}

export function contains(outer: WorldBox, inner: WorldBox): boolean {
  return [0, 1, 2].every((axis) => outer.min[axis]! <= inner.min[axis]! && inner.max[axis]! <= outer.max[axis]!);
}

export function union(a: WorldBox, b: WorldBox): WorldBox {
  const each = (pick: (...values: number[]) => number, p: Point, q: Point): Point => [
    pick(p[0], q[0]),
    pick(p[1], q[1]),
    pick(p[2], q[2]),
  ];
  return { min: each(Math.min, a.min, b.min), max: each(Math.max, a.max, b.max) };
}

export function corners({ min, max }: WorldBox): Point[] {
  return [0, 1, 2, 3, 4, 5, 6, 7].map((i): Point => [
    i & 1 ? max[0] : min[0],
    i & 2 ? max[1] : min[1],
    i & 4 ? max[2] : min[2],
  ]);
}

/** Its diagonal. */
export function size({ min, max }: WorldBox): number {
  return Math.hypot(max[0] - min[0], max[1] - min[1], max[2] - min[2]);
}
