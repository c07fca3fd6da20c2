import { validateBytes } from 'gltf-validator';
import { describe, expect, it } from 'vitest';
import type { ShownBrick, Shown } from '../src/bricks/brick_store';
import { brickKey, type EncodedBrick } from '../src/bricks/frame';
import { withNormals } from '../src/decode/computed_normals';
import { decodeBrick } from '../src/decode/decode_brick';
import { writeGlb } from '../src/save/glb';
import { writePly } from '../src/save/ply';
import { weld } from '../src/save/weld';
import { encoded, golden } from './support/golden';
import { latticeDecoder } from './support/lattice';
import { dracoDecoder, encodeBrick, flat, tetrahedron } from './support/draco';

const offsetBits = 6;
const draco = await dracoDecoder();
const decoders = { draco, lattice: await latticeDecoder() };

function shownOf(...bricks: EncodedBrick[]): Shown {
  return shownWith(undefined, ...bricks);
}

/** attribute: of those that the bricks have, the one that is decoded. */
function shownWith(attribute: string | undefined, ...bricks: EncodedBrick[]): Shown {
  const shown = new Map<string, ShownBrick>();
  for (const encoded of bricks)
    shown.set(brickKey(...encoded.place), { encoded, decoded: decodeBrick(decoders, encoded, offsetBits, attribute) });
  const attributes = bricks[0]?.attributes ?? [];
  return {
    frame: {
      index: 12n,
      simulationTime: 0.5,
      cellSize: 0.25,
      offsetBits,
      brickCells: 64,
      attributes,
    } as unknown as Shown['frame'],
    bricks: shown,
  };
}

interface Gltf {
  nodes: { mesh?: number; translation: number[]; scale?: number[]; rotation?: number[]; children?: number[] }[];
  meshes: {
    primitives: {
      attributes: Record<string, number>;
      indices: number;
      extensions: { KHR_draco_mesh_compression: { bufferView: number; attributes: Record<string, number> } };
    }[];
  }[];
  bufferViews: { byteOffset: number; byteLength: number }[];
  accessors: { count: number; bufferView?: number }[];
  extensionsRequired: string[];
}

function read(file: Uint8Array): { json: Gltf; binary: Uint8Array } {
  const view = new DataView(file.buffer);
  const textBytes = view.getUint32(12, true);
  const json = JSON.parse(new TextDecoder().decode(file.subarray(20, 20 + textBytes))) as Gltf;
  return { json, binary: file.subarray(28 + textBytes) };
}

describe('writeGlb', () => {
  it.each(['x', 'y', 'z'] as const)('passes the Khronos validator, %s up', async (up) => {
    const file = writeGlb(shownOf(await tetrahedron([0, 0, 0], 1), await tetrahedron([3, 3, 3], 3, [-2, 0, 1])), up);
    const { issues } = await validateBytes(file);
    expect(issues.messages.filter(({ severity }) => severity < 2)).toEqual([]);
  });

  it('has computed normals, which Draco bytes do not have', async () => {
    const shown = shownOf(await encodeBrick(flat));
    const bricks = [...shown.bricks].map(
      ([key, { encoded, decoded }]) => [key, { encoded, decoded: withNormals(decoded, offsetBits) }] as const,
    );
    const file = writeGlb({ ...shown, bricks: new Map(bricks) }, 'z');
    const { issues } = await validateBytes(file);
    expect(issues.messages.filter(({ severity }) => severity < 2)).toEqual([]);
    const { json } = read(file);
    expect(json.extensionsRequired).not.toContain('KHR_draco_mesh_compression');
    const { attributes } = json.meshes[0]!.primitives[0]!;
    expect(json.accessors[attributes.NORMAL!]!.bufferView).toBeDefined();
  });

  it('passes the validator without normals and without any mesh', async () => {
    const plain = await encodeBrick(flat);
    for (const shown of [shownOf(plain), shownOf()]) {
      const { issues } = await validateBytes(writeGlb(shown, 'y'));
      expect(issues.messages.filter(({ severity }) => severity < 2)).toEqual([]);
    }
  });

  it('reloads to the bricks that it was made of, each in its place', async () => {
    const shown = shownOf(await tetrahedron([0, 0, 0], 1), await tetrahedron([3, 3, 3], 3, [-2, 0, 1]));
    const { json, binary } = read(writeGlb(shown, 'y'));
    const root = json.nodes[0]!;
    const bricks = [...shown.bricks.values()];
    expect(root.children).toHaveLength(2);
    root.children!.forEach((child, i) => {
      const node = json.nodes[child]!;
      const primitive = json.meshes[node.mesh!]!.primitives[0]!;
      const { bufferView, attributes } = primitive.extensions.KHR_draco_mesh_compression;
      const { byteOffset, byteLength } = json.bufferViews[bufferView]!;
      const bytes = binary.slice(byteOffset, byteOffset + byteLength);
      expect(bytes).toEqual(bricks[i]!.encoded.data);
      const place = node.translation.map((t, axis) => (t + root.translation[axis]!) / (64 * 0.25));
      expect(place).toEqual(bricks[i]!.encoded.place);
      expect(node.scale).toEqual([0.25 / 64, 0.25 / 64, 0.25 / 64]);
      const decoder = new draco.Decoder();
      const mesh = new draco.Mesh();
      expect(decoder.DecodeArrayToMesh(bytes, bytes.length, mesh).ok()).toBe(true);
      expect(decoder.GetAttributeByUniqueId(mesh, attributes.POSITION!).data_type()).toBe(draco.DT_UINT16);
      expect(decoder.GetAttributeByUniqueId(mesh, attributes.NORMAL!).data_type()).toBe(draco.DT_FLOAT32);
      expect(json.accessors[primitive.attributes.POSITION!]!.count).toBe(mesh.num_points());
    });
  });
});

describe.skipIf(!decoders.lattice)('bricks that did not come as Draco', () => {
  const packed = encoded(golden.bricks.find(({ name }) => name === 'packed: levels and cracks, normals of 8 bits')!);

  it('lie in the GLB decoded', async () => {
    const shown = shownOf(packed);
    const { json, binary } = read(writeGlb(shown, 'y'));
    expect(json.extensionsRequired).toEqual(['KHR_mesh_quantization']);
    const { issues } = await validateBytes(writeGlb(shown, 'y'));
    expect(issues.messages.filter(({ severity }) => severity < 2)).toEqual([]);
    const [{ decoded }] = [...shown.bricks.values()] as [ShownBrick];
    const { attributes, indices } = json.meshes[0]!.primitives[0]!;
    const bytesOf = (accessor: number): Uint8Array => {
      const { byteOffset, byteLength } = json.bufferViews[json.accessors[accessor]!.bufferView!]!;
      return binary.subarray(byteOffset, byteOffset + byteLength);
    };
    for (const [accessor, array] of [
      [attributes.POSITION, decoded.positions],
      [attributes.NORMAL, decoded.normals],
      [indices, decoded.indices],
    ] as const)
      expect(bytesOf(accessor!)).toEqual(new Uint8Array(array!.buffer));
  });

  it('lie beside those that did', async () => {
    const draco = await tetrahedron([0, 0, 0], 1, [1, 0, 0]);
    const file = writeGlb(shownOf(packed, draco), 'z');
    expect(read(file).json.extensionsRequired).toEqual(['KHR_draco_mesh_compression', 'KHR_mesh_quantization']);
    const { issues } = await validateBytes(file);
    expect(issues.messages.filter(({ severity }) => severity < 2)).toEqual([]);
  });
});

const age = { name: 'age', type: 'float32', components: 1, bits: 8, minimum: [-1], maximum: [3] } as const;
const velocity = { name: 'velocity', type: 'float32', components: 3, bits: 0, minimum: [], maximum: [] } as const;
const color = { name: 'color', type: 'uint8', components: 3, bits: 0, minimum: [], maximum: [] } as const;
const id = { name: 'id', type: 'int32', components: 1, bits: 0, minimum: [], maximum: [] } as const;

/** A triangle whose vertices have these values. */
function valued(ids: readonly number[] = [-7, 8, 2 ** 31 - 1]): Promise<EncodedBrick> {
  return encodeBrick({
    ...flat,
    attributes: [
      { form: age, coded: Uint8Array.of(0, 255, 51) },
      { form: velocity, coded: Float32Array.of(1, 2, 3, 4, 5, 6, 7, 8, 9) },
      { form: color, coded: Uint8Array.of(10, 20, 30, 40, 50, 60, 70, 80, 90) },
      { form: id, coded: new Uint8Array(Int32Array.from(ids).buffer) },
    ],
  });
}

describe('what the surface is colored by', () => {
  it.each([
    ['age', 'VEC0', 4],
    ['velocity', 'VEC3', 12],
    ['color', 'VEC3', 4],
  ] as const)('is in the GLB: %s', async (name, type, stride) => {
    const shown = shownWith(name, await valued());
    const file = writeGlb(shown, 'y');
    const { issues } = await validateBytes(file);
    expect(issues.messages.filter(({ severity }) => severity < 2)).toEqual([]);
    const { json, binary } = read(file);
    const at = json.meshes[0]!.primitives[0]!.attributes[`_${name.toUpperCase()}`]!;
    const accessor = json.accessors[at]! as unknown as { bufferView: number; type: string; count: number };
    expect([accessor.type.replace('SCALAR', 'VEC0'), accessor.count]).toEqual([type, 3]);
    const { byteOffset } = json.bufferViews[accessor.bufferView]!;
    const { decoded } = [...shown.bricks.values()][0]!;
    const { values, components } = decoded.attribute!;
    const view = new DataView(binary.buffer, binary.byteOffset + byteOffset);
    for (let point = 0; point < 3; ++point)
      for (let c = 0; c < components; ++c) {
        const place = point * stride + c * (name === 'color' ? 1 : 4);
        expect(name === 'color' ? view.getUint8(place) : view.getFloat32(place, true)).toBe(
          values[components * point + c],
        );
      }
  });

  it.each([
    ['float32 where that holds all of them', [-7, 8, 2 ** 24], 5126, 'SCALAR'],
    ['two uint16, the low one first, where one does not fit', [-7, 8, 2 ** 24 + 1], 5123, 'VEC2'],
  ] as const)('is in the GLB where it is an id: as %s', async (_, ids, componentType, type) => {
    // In two bricks, of which the first alone would fit.
    const first = await valued([1, 2, 3]);
    const shown = shownWith('id', first, { ...(await valued(ids)), place: [1, 0, 0] });
    const file = writeGlb(shown, 'y');
    const { issues } = await validateBytes(file);
    expect(issues.messages.filter(({ severity }) => severity < 2)).toEqual([]);
    const { json, binary } = read(file);
    const found = json.meshes.map(({ primitives }) => {
      const accessor = json.accessors[primitives[0]!.attributes._ID!]! as unknown as { bufferView: number };
      expect(accessor).toMatchObject({ componentType, type, count: 3 });
      const view = new DataView(binary.buffer, binary.byteOffset + json.bufferViews[accessor.bufferView]!.byteOffset);
      return [0, 4, 8]
        .map((at) =>
          componentType === 5126
            ? view.getFloat32(at, true)
            : view.getUint16(at, true) | (view.getUint16(at + 2, true) << 16),
        )
        .sort((a, b) => a - b);
    });
    expect(found).toEqual([[1, 2, 3], ids]);
  });

  it.each([
    ['age', 'property float age\n', [[-1], [3], [Math.fround(-1 + (51 * 4) / 255)]]],
    [
      'velocity',
      'property float velocity_x\nproperty float velocity_y\nproperty float velocity_z\n',
      [
        [1, 2, 3],
        [4, 5, 6],
        [7, 8, 9],
      ],
    ],
    [
      'color',
      'property uchar red\nproperty uchar green\nproperty uchar blue\n',
      [
        [10, 20, 30],
        [40, 50, 60],
        [70, 80, 90],
      ],
    ],
    ['id', 'property int id\n', [[-7], [8], [2 ** 31 - 1]]],
  ])('is in the PLY: %s', async (name, properties, expected) => {
    const file = writePly(shownWith(name, await valued()));
    const text = new TextDecoder('latin1').decode(file);
    expect(text).toContain(`property float z\n${properties}element face 1\n`);
    const start = text.indexOf('end_header\n') + 'end_header\n'.length;
    const components = expected[0]!.length;
    const bytes = name === 'color' ? 1 : 4;
    const stride = 12 + components * bytes;
    expect(file.length).toBe(start + 3 * stride + 14);
    const view = new DataView(file.buffer, start);
    const found = [0, 1, 2].map((vertex) =>
      Array.from({ length: components }, (_, c) => {
        const at = vertex * stride + 12 + c * bytes;
        if (name === 'color') return view.getUint8(at);
        return name === 'id' ? view.getInt32(at, true) : view.getFloat32(at, true);
      }),
    );
    expect(found.sort((a, b) => a[0]! - b[0]!)).toEqual(expected.sort((a, b) => a[0]! - b[0]!));
  });
});

/** Two bricks with one triangle pair that meets at the face between them. */
async function twoBricks(): Promise<Shown> {
  const edge = 64 << offsetBits;
  const left = await encodeBrick({
    place: [-1, 0, 0],
    positions: [
      [edge, 10, 10],
      [edge, 90, 10],
      [edge - 50, 40, 20],
    ],
    triangles: [[0, 1, 2]],
    levels: [2],
  });
  const right = await encodeBrick({
    place: [0, 0, 0],
    positions: [
      [0, 90, 10],
      [0, 10, 10],
      [50, 40, 20],
    ],
    triangles: [[0, 1, 2]],
    levels: [3],
  });
  return shownOf(left, right);
}

describe('weld', () => {
  it('makes one vertex of those at the same place, in one brick or in two', async () => {
    const mesh = weld(await twoBricks());
    expect(mesh.vertices).toHaveLength(3 * 4);
    expect(mesh.levels).toEqual([2, 3]);
    const points = mesh.triangles.map((v) => mesh.vertices.slice(3 * v, 3 * v + 3).join(' '));
    expect(new Set(points)).toEqual(new Set(['0 10 10', '0 90 10', '-50 40 20', '50 40 20']));
  });

  it('keeps a closed brick closed', async () => {
    const { triangles } = weld(shownOf(await tetrahedron([0, 0, 0], 1)));
    const edges = new Map<string, number>();
    for (let t = 0; t < triangles.length; t += 3)
      for (let i = 0; i < 3; ++i) {
        const [a, b] = [triangles[t + i]!, triangles[t + ((i + 1) % 3)]!];
        const key = a < b ? `${a} ${b}` : `${b} ${a}`;
        edges.set(key, (edges.get(key) ?? 0) + (a < b ? 1 : -1));
      }
    expect([...edges.values()].every((balance) => balance === 0)).toBe(true);
  });
});

describe('writePly', () => {
  it('says what it holds, in world units', async () => {
    const file = writePly(await twoBricks());
    const text = new TextDecoder('latin1').decode(file);
    const headerBytes = text.indexOf('end_header\n') + 'end_header\n'.length;
    expect(text.slice(0, headerBytes)).toContain('element vertex 4\nproperty float x\n');
    expect(text.slice(0, headerBytes)).toContain(
      'element face 2\nproperty list uchar uint vertex_indices\nproperty uchar level\n',
    );
    expect(file.length).toBe(headerBytes + 4 * 12 + 2 * 14);
    const view = new DataView(file.buffer, headerBytes);
    const x = [0, 1, 2, 3].map((v) => view.getFloat32(12 * v, true)).sort((a, b) => a - b);
    expect(x).toEqual([-50, 0, 0, 50].map((steps) => (steps * 0.25) / 64));
    expect([view.getUint8(4 * 12 + 13), view.getUint8(4 * 12 + 14 + 13)]).toEqual([2, 3]);
  });

  it('has normals where the mesh has, and doubles far from the origin', async () => {
    const near = new TextDecoder('latin1').decode(writePly(shownOf(await tetrahedron([0, 0, 0], 1))));
    expect(near).toContain('property float nx');
    const far = new TextDecoder('latin1').decode(writePly(shownOf(await tetrahedron([0, 0, 0], 1, [5000, 0, 0]))));
    expect(far).toContain('property double x');
  });
});
