// One brick from its Draco bytes. Draco's own checks are not enough: what it decodes is checked against what was announced.
import type { DracoAttribute, DracoDecoder, DracoMesh, DracoModule } from 'draco3d/draco_decoder_nodejs.js';
import type { CodedAttribute } from '../bricks/attributes';
import type { EncodedBrick } from '../bricks/frame';
import { brickCells } from '../bricks/lattice';
import { storedAs, valuesOf, type DecodedAttribute } from './attribute_values';
import type { Bounds, DecodedBrick } from './decoded_brick';
import { requirePlausible } from './draco_header';
import { groupTriangles } from './group_triangles';
import { triangleGroups } from './triangle_levels';

/** The first id of generic attributes, by the contract: their places follow. */
const firstAttributeId = 16;
/** Draco's names of types. */
const dracoTypes = { uint8: 'DT_UINT8', uint16: 'DT_UINT16', float32: 'DT_FLOAT32' } as const;

/** name: of the attribute that is decoded, too, where the brick carries it. Throws an Error. */
export function decodeDracoBrick(
  draco: DracoModule,
  brick: EncodedBrick,
  offsetBits: number,
  name?: string,
): DecodedBrick {
  const decoder = new draco.Decoder();
  const mesh = new draco.Mesh();
  try {
    requirePlausible(brick);
    const status = decoder.DecodeArrayToMesh(brick.data, brick.data.length, mesh);
    if (!status.ok()) throw new Error(`its bytes are not a Draco mesh (${status.error_msg()})`);
    if (mesh.num_faces() !== brick.triangleCount)
      throw new Error(`it has ${mesh.num_faces()} triangles; announced were ${brick.triangleCount}`);
    const points = mesh.num_points();
    const named = (type: number): DracoAttribute | undefined => {
      const id = decoder.GetAttributeId(mesh, type);
      return id < 0 ? undefined : decoder.GetAttribute(mesh, id);
    };
    const read = (from: DracoAttribute, type: number, bytes: number): ArrayBuffer =>
      copyOut(draco, bytes, (to) => decoder.GetAttributeDataArrayForAllPoints(mesh, from, type, bytes, to));

    const position = named(draco.POSITION);
    if (position?.data_type() !== draco.DT_UINT16 || position.num_components() !== 3)
      throw new Error('it has no positions of three uint16');
    const positions = paddedPositions(
      new Uint16Array(read(position, draco.DT_UINT16, points * 6)),
      brickCells << offsetBits,
    );
    const normal = named(draco.NORMAL);
    const normals =
      normal?.num_components() === 3
        ? shortNormals(new Float32Array(read(normal, draco.DT_FLOAT32, points * 12)))
        : undefined;
    const triangles = readTriangles(draco, mesh, (bytes, to) => decoder.GetTrianglesUInt32Array(mesh, bytes, to));
    const groups = triangleGroups(positions, 4, triangles, brick.cellLevels, offsetBits);
    const place = brick.attributes.findIndex((attribute) => attribute.name === name);
    const attribute = place < 0 ? undefined : readAttribute(draco, decoder, mesh, brick.attributes, place, read);
    return {
      positions,
      normals,
      ...(attribute ? { attribute } : {}),
      bounds: boundsOf(positions),
      ...groupTriangles(triangles, groups, points),
    };
  } finally {
    draco.destroy(mesh);
    draco.destroy(decoder);
  }
}

function readAttribute(
  draco: DracoModule,
  decoder: DracoDecoder,
  mesh: DracoMesh,
  attributes: readonly CodedAttribute[],
  place: number,
  read: (from: DracoAttribute, type: number, bytes: number) => ArrayBuffer,
): DecodedAttribute {
  const form = attributes[place]!;
  const { name, components } = form;
  const stored = storedAs(form);
  const type = draco[dracoTypes[stored.type]];
  for (let i = 0; i < mesh.num_attributes(); ++i) {
    const attribute = decoder.GetAttribute(mesh, i);
    if (attribute.unique_id() !== firstAttributeId + place) continue;
    if (attribute.data_type() !== type || attribute.num_components() !== stored.components)
      throw new Error(`its attribute ${name} is not of the type or the components that were announced`);
    const buffer = read(attribute, type, mesh.num_points() * stored.components * stored.bytes);
    return { name, components, values: valuesOf(stored.of(buffer), form) };
  }
  throw new Error(`it has no attribute ${name}, which was announced`);
}

/** A copy of the bytes that `fill` has written to the decoder's memory. */
function copyOut(draco: DracoModule, bytes: number, fill: (to: number) => boolean): ArrayBuffer {
  const address = draco._malloc(bytes);
  try {
    if (!fill(address)) throw new Error('an attribute could not be read');
    return draco.HEAPU8.slice(address, address + bytes).buffer;
  } finally {
    draco._free(address);
  }
}

function readTriangles(draco: DracoModule, mesh: DracoMesh, fill: (bytes: number, to: number) => boolean): Uint32Array {
  const bytes = mesh.num_faces() * 12;
  const triangles = new Uint32Array(copyOut(draco, bytes, (to) => fill(bytes, to)));
  const points = mesh.num_points();
  if (triangles.some((point) => point >= points)) throw new Error('a triangle names a point that is not there');
  return triangles;
}

/** To four shorts a point, as graphics hardware reads them. */
function paddedPositions(packed: Uint16Array, last: number): Uint16Array {
  const padded = new Uint16Array((packed.length / 3) * 4);
  for (let from = 0, to = 0; from < packed.length; from += 3, to += 4)
    for (let axis = 0; axis < 3; ++axis) {
      const value = packed[from + axis]!;
      if (value > last) throw new Error('a vertex lies outside of it');
      padded[to + axis] = value;
    }
  return padded;
}

function boundsOf(positions: Uint16Array): Bounds {
  const min: [number, number, number] = [0xffff, 0xffff, 0xffff];
  const max: [number, number, number] = [0, 0, 0];
  for (let at = 0; at < positions.length; at += 4)
    for (let axis = 0; axis < 3; ++axis) {
      const value = positions[at + axis]!;
      if (value < min[axis]!) min[axis] = value;
      if (value > max[axis]!) max[axis] = value;
    }
  return { min, max };
}

function shortNormals(normals: Float32Array): Int16Array {
  const short = new Int16Array((normals.length / 3) * 4);
  for (let from = 0, to = 0; from < normals.length; from += 3, to += 4) {
    const length = Math.hypot(normals[from]!, normals[from + 1]!, normals[from + 2]!);
    for (let axis = 0; axis < 3; ++axis)
      short[to + axis] = length > 0 ? Math.round((normals[from + axis]! / length) * 32767) : 0;
  }
  return short;
}
