// Bricks that the server's encoder wrote, with the contents that the client library's decoder makes of them: the tests of
// core hold both to this file.
import { readFileSync } from 'node:fs';
import type { ElementType } from '../../src/bricks/attributes';
import type { EncodedBrick } from '../../src/bricks/frame';
import type { Codec } from '../../src/gen/meniscus/v1/mesh_pb';

export interface GoldenBrick {
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

export const golden = JSON.parse(
  readFileSync(new URL('../../../../tests/core/codec/golden_bricks.json', import.meta.url), 'utf8'),
) as Golden;

function bytes(hexadecimal: string): Uint8Array {
  return Uint8Array.from(hexadecimal.match(/../g) ?? [], (digits) => parseInt(digits, 16));
}

export function encoded(brick: GoldenBrick): EncodedBrick {
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
