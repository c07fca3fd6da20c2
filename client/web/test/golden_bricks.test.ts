// Bricks that the server's encoder wrote, with the contents that the client library's decoder makes of them: the tests of
// core hold both to this file.
import { readFileSync } from 'node:fs';
import { describe, expect, it } from 'vitest';
import { knownCodecs } from '../src/bricks/codecs';
import type { ElementType } from '../src/bricks/attributes';
import type { EncodedBrick } from '../src/bricks/frame';
import * as lattice from '../src/bricks/lattice';
import { decodeBrick } from '../src/decode/decode_brick';
import { levelCount, pointCount, type DecodedBrick } from '../src/decode/decoded_brick';
import type { Codec } from '../src/gen/meniscus/v1/mesh_pb';
import { dracoDecoder } from './support/draco';

interface GoldenBrick {
  name: string;
  offset_bits: number;
  place: [number, number, number];
  vertex_count: number;
  triangle_count: number;
  codec: Codec;
  /** Hexadecimal, here and below. */
  cell_levels: string;
  data: string;
  /** Brick-local, ascending. */
  vertices: number[][];
  /** Times 32767, in the order of the vertices; empty without normals. */
  normals: number[][];
  /** Three vertices, the least first, and the level: 1, 2, 3; crack filling 0. Ascending. */
  triangles: number[][];
  attributes?: {
    name: string;
    type: ElementType;
    components: number;
    bits: number;
    coded_minimum?: number[];
    coded_maximum?: number[];
  }[];
  /** The values of each, one vertex after the other, in their order. */
  attribute_values?: number[][];
}

interface Golden {
  base_cell_size: number;
  brick_base_cells: number;
  brick_cells: number;
  max_brick_triangles: number;
  min_offset_bits: number;
  max_offset_bits: number;
  codecs: number[];
  bricks: GoldenBrick[];
}

const golden = JSON.parse(
  readFileSync(new URL('../../../tests/core/codec/golden_bricks.json', import.meta.url), 'utf8'),
) as Golden;
const draco = await dracoDecoder();

function bytes(hexadecimal: string): Uint8Array {
  return Uint8Array.from(hexadecimal.match(/../g) ?? [], (digits) => parseInt(digits, 16));
}

function encoded(brick: GoldenBrick): EncodedBrick {
  return {
    place: brick.place,
    vertexCount: brick.vertex_count,
    triangleCount: brick.triangle_count,
    cellLevels: bytes(brick.cell_levels),
    codec: brick.codec,
    data: bytes(brick.data),
    attributes: (brick.attributes ?? []).map(({ coded_minimum, coded_maximum, ...form }) => ({
      ...form,
      minimum: coded_minimum ?? [],
      maximum: coded_maximum ?? [],
    })),
  };
}

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
      codecs: golden.codecs,
    });
  });

  it.each(golden.bricks.map((brick) => [brick.name, brick] as const))('are decoded as in core: %s', (_, brick) => {
    const decoded = decodeBrick(draco, encoded(brick), brick.offset_bits);
    const points = pointCount(decoded);
    const { vertices, ofPoint } = verticesOf(decoded, points);
    expect(vertices).toEqual(brick.vertices);
    expect(trianglesOf(decoded, ofPoint)).toEqual(brick.triangles);
    expect(decoded.normals !== undefined).toBe(brick.normals.length > 0);
    if (!decoded.normals) return;
    for (let point = 0; point < points; ++point)
      xyz(decoded.normals, point).forEach((value, axis) => {
        // Rounded from single precision in one language, from double in the other.
        expect(Math.abs(value - brick.normals[ofPoint[point]!]![axis]!)).toBeLessThanOrEqual(1);
      });
  });

  it.each(
    golden.bricks.flatMap((brick) =>
      (brick.attributes ?? []).map(({ name }, i) => [name, brick.name, brick, i] as const),
    ),
  )('have the attribute %s as in core: %s', (name, _, brick, place) => {
    const decoded = decodeBrick(draco, encoded(brick), brick.offset_bits, name);
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
