// A mesh as GLB: the Draco bytes as they came (KHR_draco_mesh_compression), positions in brick-local integers
// (KHR_mesh_quantization), a node for each brick that puts them in place. What the surface is colored by lies beside the Draco bytes, in
// the order of their points: in them it is the steps of a range, for which glTF has no words.
import type { ShownBrick, Shown } from '../bricks/brick_store';
import { brickEdge } from '../bricks/frame';
import { pointCount } from '../decode/decoded_brick';
import { toScene, type UpAxis } from '../view/up_axis';
import { glbValues, type GlbValues } from './glb_values';
import { decodedForm } from './weld';

const unsignedShort = 5123;
const unsignedInt = 5125;
const float = 5126;
const triangles = 4;
const arrayBuffer = 34962;
/** As the server adds them to a brick's Draco mesh. */
const dracoIds = { POSITION: 0, NORMAL: 1 };

interface View {
  readonly buffer: number;
  readonly byteOffset: number;
  readonly byteLength: number;
  readonly byteStride?: number;
  readonly target?: number;
}

export function writeGlb(shown: Shown, up: UpAxis): Uint8Array {
  const bricks = [...shown.bricks.values()].filter(({ encoded }) => encoded.triangleCount > 0);
  const form = decodedForm(bricks, shown.frame.attributes);
  const values =
    form &&
    glbValues(
      form,
      bricks.map(({ decoded }) => decoded),
    );
  const views: View[] = [];
  const parts: Uint8Array[] = [];
  let bytes = 0;
  const add = (part: Uint8Array, properties: Pick<View, 'byteStride' | 'target'> = {}): void => {
    views.push({ buffer: 0, byteOffset: bytes, byteLength: part.length, ...properties });
    parts.push(part);
    bytes = aligned(bytes + part.length);
  };
  for (const { encoded } of bricks) add(encoded.data);
  for (const part of values?.bytes ?? []) add(part, { byteStride: values!.stride, target: arrayBuffer });
  const binary = new Uint8Array(bytes);
  parts.forEach((part, i) => {
    binary.set(part, views[i]!.byteOffset);
  });
  return container(document(shown, bricks, values, views, bytes, up), binary);
}

function document(
  shown: Shown,
  bricks: ShownBrick[],
  values: GlbValues | undefined,
  views: View[],
  bytes: number,
  up: UpAxis,
): object {
  const { frame } = shown;
  const asset = {
    version: '2.0',
    generator: 'Meniscus viewer',
    extras: { frame: Number(frame.index), simulationTime: frame.simulationTime },
  };
  // A file without a mesh has no list at all: the format has no empty lists.
  if (bricks.length === 0) return { asset, scene: 0, scenes: [{ name: 'no surface' }] };
  const accessors: object[] = [];
  const meshes = bricks.map(({ encoded, decoded }, i) => {
    const points = pointCount(decoded);
    const add = (accessor: object): number => accessors.push(accessor) - 1;
    const indices = add({ componentType: unsignedInt, count: decoded.indices.length, type: 'SCALAR' });
    const POSITION = add({
      componentType: unsignedShort,
      count: points,
      type: 'VEC3',
      min: decoded.bounds.min,
      max: decoded.bounds.max,
    });
    const normal = decoded.normals ? { NORMAL: add({ componentType: float, count: points, type: 'VEC3' }) } : {};
    const value = values
      ? {
          [values.name]: add({
            bufferView: bricks.length + i,
            componentType: values.componentType,
            count: points,
            type: values.type,
          }),
        }
      : {};
    const dracoAttributes = decoded.normals ? dracoIds : { POSITION: dracoIds.POSITION };
    return {
      name: `brick ${encoded.place.join(' ')}`,
      primitives: [
        {
          attributes: { POSITION, ...normal, ...value },
          indices,
          material: 0,
          mode: triangles,
          extensions: { KHR_draco_mesh_compression: { bufferView: i, attributes: dracoAttributes } },
        },
      ],
    };
  });
  return {
    asset,
    extensionsUsed: ['KHR_draco_mesh_compression', 'KHR_mesh_quantization'],
    extensionsRequired: ['KHR_draco_mesh_compression', 'KHR_mesh_quantization'],
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: nodes(shown, bricks, up),
    meshes,
    materials: [
      {
        name: 'water',
        pbrMetallicRoughness: { baseColorFactor: [0.1, 0.38, 0.5, 1], metallicFactor: 0, roughnessFactor: 0.1 },
      },
    ],
    accessors,
    bufferViews: views,
    buffers: [{ byteLength: bytes }],
  };
}

/** The root has the place in the world, in one number per axis; the bricks below it are then exact in single precision too. */
function nodes({ frame }: Shown, bricks: ShownBrick[], up: UpAxis): object[] {
  const edge = brickEdge(frame);
  const step = frame.cellSize / 2 ** frame.offsetBits;
  const first = bricks[0]!.encoded.place;
  const translation = (place: readonly number[], from: readonly number[]): number[] =>
    place.map((p, axis) => (p - from[axis]!) * edge);
  // glTF is y-up.
  const turns = { x: { rotation: [0.5, 0.5, 0.5, 0.5] }, y: {}, z: { rotation: [-Math.SQRT1_2, 0, 0, Math.SQRT1_2] } };
  const [x, y, z] = translation(first, [0, 0, 0]) as [number, number, number];
  return [
    {
      name: 'surface',
      translation: toScene([x, y, z], [0, 0, 0], up).toArray(),
      ...turns[up],
      children: bricks.map((_, i) => i + 1),
    },
    ...bricks.map(({ encoded }, i) => ({
      mesh: i,
      translation: translation(encoded.place, first),
      scale: [step, step, step],
    })),
  ];
}

function container(json: object, binary: Uint8Array): Uint8Array {
  const text = new TextEncoder().encode(JSON.stringify(json));
  const textBytes = aligned(text.length);
  const headerBytes = 12 + 8 + textBytes + (binary.length > 0 ? 8 : 0);
  const file = new Uint8Array(headerBytes + binary.length).fill(0x20, 20 + text.length, 20 + textBytes);
  const header = new DataView(file.buffer);
  [0x46546c67, 2, file.length, textBytes, 0x4e4f534a].forEach((value, i) => {
    header.setUint32(4 * i, value, true);
  });
  file.set(text, 20);
  if (binary.length > 0) {
    header.setUint32(20 + textBytes, binary.length, true);
    header.setUint32(24 + textBytes, 0x004e4942, true);
    file.set(binary, 28 + textBytes);
  }
  return file;
}

function aligned(bytes: number): number {
  return (bytes + 3) & ~3;
}
