import { describe, expect, it } from 'vitest';
import type { Shown } from '../src/bricks/brick_store';
import { occupied } from '../src/view/occupied';

/** One brick of these vertices, in steps of 1/16. */
function shown(
  vertices: readonly (readonly [number, number, number])[],
  place: readonly [number, number, number],
): Shown {
  const positions = Uint16Array.from(vertices.flatMap((vertex) => [...vertex, 0]));
  const of = (pick: (...values: number[]) => number): number[] =>
    [0, 1, 2].map((axis) => pick(...vertices.map((vertex) => vertex[axis]!)));
  const bricks = new Map([
    ['brick', { encoded: { place }, decoded: { positions, bounds: { min: of(Math.min), max: of(Math.max) } } }],
  ]);
  return { frame: { cellSize: 1, offsetBits: 4, brickCells: 8 }, bricks } as unknown as Shown;
}

describe('the cells that a surface occupies', () => {
  const vertices = [
    [0, 0, 0],
    [96, 0, 0],
    [48, 16, 32],
  ] as const;

  it('lie within half a cell of its vertices, whatever their order and number', () => {
    const cells = occupied(shown(vertices, [2, -1, 0]));
    expect(cells).toHaveLength(3);
    for (const [x, y, z] of vertices) {
      const world = [16 + x / 16, -8 + y / 16, z / 16];
      const near = cells.filter((cell) => cell.every((at, axis) => Math.abs(at - world[axis]!) <= 6 / 48));
      expect(near).toHaveLength(1);
    }
    expect(occupied(shown([...vertices].reverse().concat(vertices), [2, -1, 0]))).toEqual(cells);
  });

  it('are one of a single vertex, and none of none', () => {
    expect(occupied(shown([[5, 5, 5]], [0, 0, 0]))).toHaveLength(1);
    expect(occupied({ ...shown([[5, 5, 5]], [0, 0, 0]), bricks: new Map() })).toEqual([]);
  });
});
