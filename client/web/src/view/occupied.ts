// Where the surface is, roughly: what a camera is to show. Neither the order nor the density of the vertices matters to it, so that all codecs
// and all levels give one view.
import type { Shown } from '../bricks/brick_store';
import { brickEdge } from '../bricks/frame';
import { worldBox, type Point } from './bounds';

/** Cells along the longest side of the box around the mesh. */
const resolution = 48;

/** The middles of the cells of a coarse grid that hold a vertex, world units; empty for an empty mesh. */
export function occupied(shown: Shown): Point[] {
  const box = worldBox(shown);
  if (!box) return [];
  const { frame, bricks } = shown;
  const sides = [0, 1, 2].map((axis) => box.max[axis]! - box.min[axis]!);
  const cell = Math.max(...sides) / resolution || 1;
  const [nx, ny, nz] = sides.map((side) => Math.floor(side / cell) + 1) as Point;
  const taken = new Uint8Array(nx * ny * nz);
  const edge = brickEdge(frame);
  const step = frame.cellSize / 2 ** frame.offsetBits / cell;
  for (const { encoded, decoded } of bricks.values()) {
    const [x, y, z] = encoded.place.map((place, axis) => (place * edge - box.min[axis]!) / cell) as Point;
    const { positions } = decoded;
    const within = (at: number, count: number): number => Math.min(Math.max(Math.floor(at), 0), count - 1);
    for (let i = 0; i < positions.length; i += 4) {
      const ix = within(x + step * positions[i]!, nx);
      const iy = within(y + step * positions[i + 1]!, ny);
      const iz = within(z + step * positions[i + 2]!, nz);
      taken[ix + nx * (iy + ny * iz)] = 1;
    }
  }
  const middle = (index: number, axis: number): number =>
    Math.min(box.min[axis]! + (index + 0.5) * cell, box.max[axis]!);
  const points: Point[] = [];
  for (let at = taken.indexOf(1); at >= 0; at = taken.indexOf(1, at + 1))
    points.push([middle(at % nx, 0), middle(Math.floor(at / nx) % ny, 1), middle(Math.floor(at / (nx * ny)), 2)]);
  return points;
}
