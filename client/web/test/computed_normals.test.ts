// Normals that the viewer computes, against those of the whole mesh by a plain sum.
import { describe, expect, it } from 'vitest';
import type { ShownBrick } from '../src/bricks/brick_store';
import { brickKey, type BrickKey, type EncodedBrick } from '../src/bricks/frame';
import { joinNormals } from '../src/bricks/joined_normals';
import { brickCells } from '../src/bricks/lattice';
import { withNormals } from '../src/decode/computed_normals';
import { pointCount, type DecodedBrick } from '../src/decode/decoded_brick';

type Vector = readonly [number, number, number];
type Triangle = readonly [Vector, Vector, Vector];
interface Leveled {
  readonly corners: Triangle;
  readonly level: number;
}
type Bricks = ReadonlyMap<BrickKey, ShownBrick>;

const offsetBits = 2;
const edge = brickCells << offsetBits;
const crack = 3;

/** The same numbers in every run, from 0 to 1. */
function numbers(seed: number): () => number {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

/** As it comes from a decoder. split: whether triangles have points of their own, as some of Draco's have. */
function brickOf(place: Vector, triangles: readonly Leveled[], split = false): DecodedBrick {
  const points: number[] = [];
  const known = new Map<string, number>();
  const indices: number[] = [];
  const levelTriangles: [number, number, number, number] = [0, 0, 0, 0];
  for (const { corners, level } of [...triangles].sort((a, b) => a.level - b.level)) {
    ++levelTriangles[level]!;
    for (const corner of corners) {
      const local = corner.map((coordinate, axis) => coordinate - place[axis]! * edge);
      const key = local.join();
      let point = split ? undefined : known.get(key);
      if (point === undefined) {
        point = points.length / 4;
        known.set(key, point);
        points.push(...local, 0);
      }
      indices.push(point);
    }
  }
  return {
    positions: Uint16Array.from(points),
    normals: undefined,
    indices: Uint16Array.from(indices),
    levelTriangles,
    bounds: { min: [0, 0, 0], max: [edge, edge, edge] },
  };
}

function shown(place: Vector, triangles: readonly Leveled[], split = false): [BrickKey, ShownBrick] {
  const encoded = { place } as unknown as EncodedBrick;
  return [brickKey(...place), { encoded, decoded: withNormals(brickOf(place, triangles, split), offsetBits) }];
}

/** By the points' places: the sum of each over all triangles but crack filling, or over that alone. */
function oracle(triangles: readonly Leveled[]): Map<string, Vector> {
  const sums = new Map<string, { ordinary: number[]; filling: number[] }>();
  for (const { corners, level } of triangles)
    for (let i = 0; i < 3; ++i) {
      const [a, b, c] = [corners[i]!, corners[(i + 1) % 3]!, corners[(i + 2) % 3]!];
      const [e, g] = [b, c].map((p) => p.map((x, axis) => x - a[axis]!)) as [number[], number[]];
      const weight = 1 / (Math.hypot(...e) ** 2 * Math.hypot(...g) ** 2);
      const normal = [0, 1, 2].map((k) => e[(k + 1) % 3]! * g[(k + 2) % 3]! - e[(k + 2) % 3]! * g[(k + 1) % 3]!);
      const at = sums.get(a.join()) ?? { ordinary: [0, 0, 0], filling: [0, 0, 0] };
      sums.set(a.join(), at);
      const sum = level === crack ? at.filling : at.ordinary;
      for (let k = 0; k < 3; ++k) sum[k]! += normal[k]! * weight;
    }
  return new Map(
    [...sums].map(([place, { ordinary, filling }]) => {
      const sum = Math.hypot(...ordinary) > 0 ? ordinary : filling;
      return [place, sum.map((x) => x / Math.hypot(...sum)) as unknown as Vector];
    }),
  );
}

/** Fails unless each point has the oracle's normal, and points in one place have the same, to the bit. */
function expectWholeMesh(bricks: Bricks, triangles: readonly Leveled[]): void {
  const expected = oracle(triangles);
  const seen = new Map<string, string>();
  for (const { encoded, decoded } of bricks.values())
    for (let point = 0; point < pointCount(decoded); ++point) {
      const place = [0, 1, 2].map((axis) => decoded.positions[4 * point + axis]! + encoded.place[axis]! * edge).join();
      const normal = [0, 1, 2].map((axis) => decoded.normals![4 * point + axis]!);
      const difference = Math.max(...normal.map((x, axis) => Math.abs(x - 32767 * expected.get(place)![axis]!)));
      expect(difference, place).toBeLessThan(1.5);
      if (seen.has(place)) expect(normal.join(), place).toBe(seen.get(place));
      seen.set(place, normal.join());
    }
  expect(seen.size).toBe(expected.size);
}

const octants: Vector[] = [0, 1, 2, 3, 4, 5, 6, 7].map((o) => [-(o & 1), -((o >> 1) & 1), -(o >> 2)] as Vector);

/** A rough ball around the corner of eight bricks, by brick. seed: of its dents within bricks; their faces stay. */
function ball(seed: number): Map<BrickKey, { place: Vector; triangles: Leveled[] }> {
  const rows = 9;
  const shared = numbers(7);
  const radii = Array.from({ length: 64 }, () => 60 + 60 * shared());
  return new Map(
    octants.map((place, octant) => {
      const random = numbers(seed * 8 + octant);
      const grid = Array.from({ length: rows + 1 }, (_, i) =>
        Array.from({ length: rows + 1 - i }, (_, j): Vector => {
          const weights = [i, j, rows - i - j];
          // On a face of the brick all that share it have to find the same place.
          const face = weights.includes(0);
          const radius = face ? radii[(i * 31 + j * 17) % 64]! : 60 + 60 * random();
          return weights.map(
            (w, axis) => (place[axis] === 0 ? 1 : -1) * Math.round((w / rows) * radius),
          ) as unknown as Vector;
        }),
      );
      const flip = place.filter((x) => x !== 0).length % 2 === 1;
      const triangles: Leveled[] = [];
      const add = (a: Vector, b: Vector, c: Vector): void => {
        const level = Math.floor(random() * 5) % 4;
        triangles.push({ corners: flip ? [a, c, b] : [a, b, c], level });
      };
      for (let i = 0; i < rows; ++i)
        for (let j = 0; j < rows - i; ++j) {
          add(grid[i]![j]!, grid[i + 1]![j]!, grid[i]![j + 1]!);
          if (i + j < rows - 1) add(grid[i + 1]![j]!, grid[i + 1]![j + 1]!, grid[i]![j + 1]!);
        }
      return [brickKey(...place), { place, triangles }];
    }),
  );
}

const none: Bricks = new Map();
const all = (parts: ReturnType<typeof ball>): Leveled[] => [...parts.values()].flatMap(({ triangles }) => triangles);
const bricksOf = (parts: ReturnType<typeof ball>, split = false): Map<BrickKey, ShownBrick> =>
  new Map([...parts.values()].map(({ place, triangles }) => shown(place, triangles, split)));

describe('computed normals', () => {
  it('are known ones, of a plane', () => {
    const [a, b, c, d]: Vector[] = [
      [10, 10, 10],
      [15, 10, 5],
      [10, 24, 3],
      [1, 12, 18],
    ] as never;
    const { normals } = withNormals(
      brickOf(
        [0, 0, 0],
        [
          { corners: [a!, b!, c!], level: 2 },
          { corners: [a!, c!, d!], level: 0 },
        ],
      ),
      offsetBits,
    );
    for (let point = 0; point < 4; ++point)
      expect([...normals!.slice(4 * point, 4 * point + 3)]).toEqual([2, 1, 2].map((n) => Math.round((n * 32767) / 3)));
  });

  it('are not moved by triangles without an area, and point up where there are no others', () => {
    const [a, b, c, d, e, f]: Vector[] = [
      [1, 1, 1],
      [5, 1, 1],
      [1, 9, 1],
      [40, 40, 40],
      [42, 42, 42],
      [47, 47, 47],
    ] as never;
    const flat: Triangle[] = [
      [a!, a!, b!],
      [a!, b!, a!],
      [c!, c!, c!],
      [d!, e!, f!],
      [d!, d!, a!],
    ];
    const { normals } = withNormals(
      brickOf([0, 0, 0], [{ corners: [a!, b!, c!], level: 0 }, ...flat.map((corners) => ({ corners, level: 1 }))]),
      offsetBits,
    );
    for (let point = 0; point < 6; ++point)
      expect([...normals!.slice(4 * point, 4 * point + 3)]).toEqual([0, 0, 32767]);
  });

  it('leave those alone that came', () => {
    const brick = { ...brickOf([0, 0, 0], []), normals: new Int16Array(4) };
    expect(withNormals(brick, offsetBits)).toBe(brick);
  });
});

/** As if its normals had come with it. */
function withoutBorder({ encoded, decoded }: ShownBrick): ShownBrick {
  const { border, ...sent } = decoded;
  expect(border).toBeDefined();
  return { encoded, decoded: sent };
}

describe('normals of points that bricks share', () => {
  it.each([false, true])(
    'are those of the whole mesh, without a seam (triangles with points of their own: %s)',
    (split) => {
      for (let seed = 0; seed < 10; ++seed) {
        const parts = ball(seed);
        const bricks = bricksOf(parts, split);
        // So their sums are exact in every order.
        for (const { decoded } of bricks.values())
          expect(decoded.border!.sums.every((sum) => Number.isInteger(sum * 2 ** 44))).toBe(true);
        expectWholeMesh(joinNormals(bricks, none, offsetBits), all(parts));
      }
    },
  );

  it('follow a brick that changes, and one that goes, in bricks that do not', () => {
    const parts = ball(1);
    const first = joinNormals(bricksOf(parts), none, offsetBits);
    const [key, { place }] = [...parts][0]!;
    const { triangles } = ball(2).get(key)!;
    const second = joinNormals(new Map([...first, shown(place, triangles)]), first, offsetBits);
    const changed = all(new Map([...parts, [key, { place, triangles }]]));
    expectWholeMesh(second, changed);
    const third = joinNormals(new Map([...second].filter(([other]) => other !== key)), second, offsetBits);
    expectWholeMesh(third, all(new Map([...parts].filter(([other]) => other !== key))));
    const fourth = joinNormals(new Map([...third, shown(place, triangles)]), third, offsetBits);
    expectWholeMesh(fourth, changed);
    // What was shown stays as it was.
    expectWholeMesh(first, all(parts));
  });

  it('replace those bricks alone in which they change', () => {
    const parts = ball(1);
    const first = joinNormals(bricksOf(parts), none, offsetBits);
    const again = joinNormals(new Map(first), first, offsetBits);
    for (const [key, brick] of first) expect(again.get(key)).toBe(brick);
    const [key, { place }] = [...parts][0]!;
    const { triangles } = ball(2).get(key)!;
    const second = joinNormals(new Map([...first, shown(place, triangles)]), first, offsetBits);
    const across = octants.find((other) => other.every((x, axis) => x !== place[axis]))!;
    expect(second.get(brickKey(...across))).toBe(first.get(brickKey(...across)));
    expect([...second].filter(([other, brick]) => brick !== first.get(other)).length).toBeGreaterThan(3);
    // The same content, decoded anew: neighbors find the same sums.
    const { triangles: same } = parts.get(key)!;
    const decoded = joinNormals(new Map([...first, shown(place, same)]), first, offsetBits);
    for (const [other, brick] of first) if (other !== key) expect(decoded.get(other)).toBe(brick);
  });

  it('cost no copy of bricks that all came with normals', () => {
    const bricks = new Map([...bricksOf(ball(4))].map(([key, brick]) => [key, withoutBorder(brick)]));
    expect(joinNormals(bricks, none, offsetBits)).toBe(bricks);
    const next = new Map([...bricks].slice(1));
    expect(joinNormals(next, bricks, offsetBits)).toBe(next);
  });

  it('are left as they came beside bricks with normals of the server', () => {
    const parts = ball(3);
    const bricks = bricksOf(parts);
    const [key, brick] = [...bricks][0]!;
    const sent = withoutBorder(brick);
    bricks.set(key, sent);
    expect(joinNormals(bricks, none, offsetBits).get(key)).toBe(sent);
  });
});
