import { describe, expect, it } from 'vitest';
import type { Shown } from '../src/bricks/brick_store';
import type { DecodedBrick } from '../src/decode/decoded_brick';
import type { Point } from '../src/view/bounds';
import type { Cut } from '../src/view/cut';
import { pick, type WorldRay } from '../src/view/pick';

/** Steps of a brick's edge: 64 cells of 2^2 steps of 0.25. */
const [cellSize, offsetBits, brickCells] = [1, 2, 64];

/** A cube from 40 to 80 steps on each axis, as wide as 10 units; outwards, six triangles of level 1, four of level 2, two of level 3. */
function cube(): DecodedBrick {
  const positions = new Uint16Array(32);
  for (let i = 0; i < 8; ++i) for (let axis = 0; axis < 3; ++axis) positions[4 * i + axis] = (i >> axis) & 1 ? 80 : 40;
  const faces = [
    [0, 4, 6, 2], // x = 40
    [1, 3, 7, 5], // x = 80
    [0, 1, 5, 4], // y = 40
    [2, 6, 7, 3], // y = 80
    [0, 2, 3, 1], // z = 40
    [4, 5, 7, 6], // z = 80
  ];
  return {
    positions,
    normals: undefined,
    indices: new Uint16Array(faces.flatMap(([a, b, c, d]) => [a!, b!, c!, a!, c!, d!])),
    levelTriangles: [6, 4, 2, 0],
    bounds: { min: [40, 40, 40], max: [80, 80, 80] },
  };
}

/** The cube in the brick of that place: its smallest corner lies at 64 times the place, plus 10. */
function shownAt(place: Point): Shown {
  return {
    frame: { cellSize, offsetBits, brickCells } as Shown['frame'],
    bricks: new Map([['brick', { encoded: { place } as never, decoded: cube() }]]),
  };
}

const along = (origin: Point, direction: Point): WorldRay => ({ origin, direction });

describe('a pick', () => {
  const shown = shownAt([0, 0, 0]);

  it('finds the nearest point of the surface, and the level of its triangle', () => {
    expect(pick(shown, along([100, 14, 13], [-1, 0, 0]), undefined)).toMatchObject({
      place: [20, 14, 13],
      level: 'level 1',
    });
    expect(pick(shown, along([14, 100, 13], [0, -1, 0]), undefined)).toMatchObject({
      place: [14, 20, 13],
      level: 'level 2',
    });
    expect(pick(shown, along([14, 13, 100], [0, 0, -1]), undefined)).toMatchObject({
      place: [14, 13, 20],
      level: 'level 3',
    });
  });

  it('finds the place of the point in its triangle', () => {
    const { place, spot } = pick(shown, along([100, 14, 13], [-1, 0, 0]), undefined)!;
    const { brick, points, weights } = spot!;
    // The face x = 80, in steps of a quarter.
    for (const point of points) expect(brick.positions[4 * point]).toBe(80);
    for (const axis of [0, 1, 2]) {
      const mean = points.reduce((sum, point, i) => sum + weights[i]! * brick.positions[4 * point + axis]!, 0);
      expect(mean / 4).toBeCloseTo(place[axis]!, 10);
    }
  });

  it('finds nothing beside the water, nor behind the eye', () => {
    expect(pick(shown, along([100, 30, 13], [-1, 0, 0]), undefined)).toBeUndefined();
    expect(pick(shown, along([100, 14, 13], [1, 0, 0]), undefined)).toBeUndefined();
  });

  it('is exact far from the origin', () => {
    const far = shownAt([15625, 0, 0]);
    const found = pick(far, along([1e6 + 100, 14, 13], [-1, 0, 0]), undefined);
    expect(found?.place).toEqual([1e6 + 20, 14, 13]);
  });

  describe('of water that is cut', () => {
    const cut: Cut = { axis: 'x', at: 16, away: 'beyond' };

    it('finds the face of the cut, inside of the water', () => {
      expect(pick(shown, along([100, 14, 13], [-1, 0, 0]), cut)).toEqual({
        place: [16, 14, 13],
        level: undefined,
        spot: undefined,
      });
    });

    it('finds what is kept as before, seen from its own side', () => {
      expect(pick(shown, along([-100, 14, 13], [1, 0, 0]), cut)).toMatchObject({
        place: [10, 14, 13],
        level: 'level 1',
      });
    });

    it('finds nothing of what is taken away', () => {
      expect(pick(shown, along([18, 100, 13], [0, -1, 0]), cut)).toBeUndefined();
      expect(pick(shown, along([100, 30, 13], [-1, 0, 0]), cut)).toBeUndefined();
      expect(pick(shown, along([100, 14, 13], [-1, 0, 0]), { ...cut, at: 5 })).toBeUndefined();
    });
  });
});
