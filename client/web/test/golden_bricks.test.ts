import { describe, expect, it } from 'vitest';
import { isKnownCodec, knownCodecs } from '../src/bricks/codecs';
import * as lattice from '../src/bricks/lattice';
import { decodeBrick, type Decoders } from '../src/decode/decode_brick';
import { levelCount, pointCount, type DecodedBrick } from '../src/decode/decoded_brick';
import { Codec } from '../src/gen/meniscus/v1/mesh_pb';
import { dracoDecoder } from './support/draco';
import { encoded, golden } from './support/golden';
import { latticeDecoder } from './support/lattice';

const decoders: Decoders = { draco: await dracoDecoder(), lattice: await latticeDecoder() };
const bricks = golden.bricks.filter(({ codec }) => isKnownCodec(codec));

function ascending(a: number[], b: number[]): number {
  for (let i = 0; i < a.length; ++i) if (a[i] !== b[i]) return a[i]! - b[i]!;
  return 0;
}

const xyz = (values: ArrayLike<number>, point: number): number[] => [0, 1, 2].map((axis) => values[4 * point + axis]!);

/** Points at one position are one vertex: the numbers of the points' vertices, in ascending order of position. */
function verticesOf({ positions }: DecodedBrick, points: number): { vertices: number[][]; ofPoint: number[] } {
  const byKey = new Map(
    Array.from({ length: points }, (_, point) => [xyz(positions, point).join(), xyz(positions, point)]),
  );
  const vertices = [...byKey.values()].sort(ascending);
  const numbers = new Map(vertices.map((position, i) => [position.join(), i]));
  return {
    vertices,
    ofPoint: Array.from({ length: points }, (_, point) => numbers.get(xyz(positions, point).join())!),
  };
}

function trianglesOf({ indices, levelTriangles }: DecodedBrick, ofPoint: number[]): number[][] {
  const levels = levelTriangles.flatMap((count, group) => new Array<number>(count).fill((group + 1) % levelCount));
  return levels
    .map((level, t) => {
      const corners = [0, 1, 2].map((i) => ofPoint[indices[3 * t + i]!]!);
      const least = corners.indexOf(Math.min(...corners));
      return [...corners.slice(least), ...corners.slice(0, least), level];
    })
    .sort(ascending);
}

describe('golden bricks', () => {
  it('have the constants of core', () => {
    expect({ ...lattice, codecs: [...knownCodecs] }).toEqual({
      baseCellSize: golden.base_cell_size,
      brickBaseCells: golden.brick_base_cells,
      brickCells: golden.brick_cells,
      maxBrickTriangles: golden.max_brick_triangles,
      minOffsetBits: golden.min_offset_bits,
      maxOffsetBits: golden.max_offset_bits,
      codecs: decoders.lattice ? golden.codecs : [Codec.DRACO],
    });
  });

  it.each(bricks.map((brick) => [brick.name, brick] as const))('are decoded as in core: %s', (_, brick) => {
    const decoded = decodeBrick(decoders, encoded(brick), brick.offset_bits);
    const points = pointCount(decoded);
    const { vertices, ofPoint } = verticesOf(decoded, points);
    expect(vertices).toEqual(brick.vertices);
    expect(trianglesOf(decoded, ofPoint)).toEqual(brick.triangles);
    expect(decoded.normals !== undefined).toBe(brick.normals.length > 0);
    if (!decoded.normals) return;
    // Draco's are rounded from double precision here, from single precision in core.
    const difference = brick.codec === Codec.DRACO ? 1 : 0;
    for (let point = 0; point < points; ++point)
      xyz(decoded.normals, point).forEach((value, axis) => {
        expect(Math.abs(value - brick.normals[ofPoint[point]!]![axis]!)).toBeLessThanOrEqual(difference);
      });
  });

  it.each(
    bricks.flatMap((brick) => (brick.attributes ?? []).map(({ name }, i) => [name, brick.name, brick, i] as const)),
  )('have the attribute %s as in core: %s', (name, _, brick, place) => {
    const decoded = decodeBrick(decoders, encoded(brick), brick.offset_bits, name);
    const { values, components } = decoded.attribute!;
    const { ofPoint } = verticesOf(decoded, pointCount(decoded));
    const expected = brick.attribute_values![place]!;
    ofPoint.forEach((vertex, point) => {
      expect([...values.subarray(components * point, components * (point + 1))]).toEqual(
        expected.slice(components * vertex, components * (vertex + 1)),
      );
    });
  });
});
