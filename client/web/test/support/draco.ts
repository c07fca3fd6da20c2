// Draco itself: the decoder that the viewer ships, and the encoder, to make bricks as the server does.
import createDecoder, { type DracoModule } from 'draco3d/draco_decoder_nodejs.js';
import createEncoder from 'draco3d/draco_encoder_nodejs.js';
import type { CodedAttribute } from '../../src/bricks/attributes';
import type { EncodedBrick } from '../../src/bricks/frame';
import { Codec } from '../../src/gen/meniscus/v1/mesh_pb';

export function dracoDecoder(): Promise<DracoModule> {
  return createDecoder();
}

export interface BrickOptions {
  place?: [number, number, number];
  /** Brick-local. */
  positions: [number, number, number][];
  normals?: [number, number, number][];
  triangles: [number, number, number][];
  /** The levels of the base cells that hold triangles, in order. */
  levels: number[];
  /** As the server codes them: numbers of uint8, uint16 or float32; of an id its four bytes. */
  attributes?: { form: CodedAttribute; coded: Uint8Array | Uint16Array | Float32Array }[];
}

export async function encodeBrick({
  place = [0, 0, 0],
  positions,
  normals,
  triangles,
  levels,
  attributes = [],
}: BrickOptions): Promise<EncodedBrick> {
  const draco = await createEncoder();
  const builder = new draco.MeshBuilder();
  const mesh = new draco.Mesh();
  builder.AddFacesToMesh(mesh, triangles.length, new Uint32Array(triangles.flat()));
  builder.AddUInt16Attribute(mesh, draco.POSITION, positions.length, 3, new Uint16Array(positions.flat()));
  const encoder = new draco.Encoder();
  encoder.SetEncodingMethod(draco.MESH_EDGEBREAKER_ENCODING);
  if (normals) {
    builder.AddFloatAttribute(mesh, draco.NORMAL, normals.length, 3, new Float32Array(normals.flat()));
    encoder.SetAttributeQuantization(draco.NORMAL, 8);
  }
  for (const { coded } of attributes) {
    const components = coded.length / positions.length;
    if (coded instanceof Uint8Array)
      builder.AddUInt8Attribute(mesh, draco.GENERIC, positions.length, components, coded);
    else if (coded instanceof Uint16Array)
      builder.AddUInt16Attribute(mesh, draco.GENERIC, positions.length, components, coded);
    else builder.AddFloatAttribute(mesh, draco.GENERIC, positions.length, components, coded);
  }
  const bytes = new draco.DracoInt8Array();
  const size = encoder.EncodeMeshToDracoBuffer(mesh, bytes);
  if (size === 0) throw new Error('Draco could not encode the brick');
  const encoded = Uint8Array.from({ length: size }, (_, i) => bytes.GetValue(i) & 0xff);
  attributes.forEach(({ coded }, place) => {
    nameAttribute(encoded, coded, coded.length / positions.length, (normals ? 2 : 1) + place, 16 + place);
  });
  const packed = new Uint8Array(Math.ceil(levels.length / 4));
  levels.forEach((level, i) => {
    packed[i >> 2]! |= level << (2 * (i & 3));
  });
  return {
    place,
    vertexCount: positions.length,
    triangleCount: triangles.length,
    cellLevels: packed,
    codec: Codec.DRACO,
    data: encoded,
    attributes: attributes.map(({ form }) => form),
  };
}

/** Gives the attribute, which the encoder numbers, the server's number: its description is type, data type, components, 0, number. */
function nameAttribute(
  data: Uint8Array,
  coded: Uint8Array | Uint16Array | Float32Array,
  components: number,
  number: number,
  id: number,
): void {
  const generic = 4;
  const dataType = coded instanceof Uint8Array ? 2 : coded instanceof Uint16Array ? 4 : 9;
  const description = [generic, dataType, components, 0, number];
  const at = data.findIndex((_, i) => description.every((byte, k) => data[i + k] === byte));
  if (at < 0) throw new Error('the attribute was not found in its brick');
  data[at + 4] = id;
}

/** One triangle of level 1, without normals. */
export const flat: BrickOptions = {
  positions: [
    [1, 1, 1],
    [9, 1, 2],
    [1, 9, 3],
  ],
  triangles: [[0, 1, 2]],
  levels: [1],
};

const step = 64;

/** A closed tetrahedron inside one base cell (4 cells of 64 steps a side); corner: that cell's, in base cells. */
export function tetrahedron(
  corner: [number, number, number],
  level: number,
  place: [number, number, number] = [0, 0, 0],
): Promise<EncodedBrick> {
  const [x, y, z] = corner.map((c) => c * 4 * step) as [number, number, number];
  return encodeBrick({
    place,
    positions: [
      [x + 10, y + 10, z + 10],
      [x + 200, y + 20, z + 15],
      [x + 30, y + 190, z + 25],
      [x + 40, y + 35, z + 210],
    ],
    normals: [
      [-0.577, -0.577, -0.577],
      [1, 0, 0],
      [0, 1, 0],
      [0, 0, 1],
    ],
    triangles: [
      [0, 2, 1],
      [0, 1, 3],
      [0, 3, 2],
      [1, 2, 3],
    ],
    levels: [level],
  });
}
