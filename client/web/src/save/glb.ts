// A mesh as GLB: positions in brick-local integers (KHR_mesh_quantization), a node for each brick that puts them in place. Bricks that
// came as Draco stay as they came (KHR_draco_mesh_compression); of other codecs glTF knows nothing, and their bricks lie there decoded.
// What the surface is colored by lies beside the Draco bytes, in the order of their points: in them it is the steps of a range, for which
// glTF has no words.
import type { ShownBrick, Shown } from '../bricks/brick_store';
import { brickEdge, type EncodedBrick } from '../bricks/frame';
import { pointCount, type DecodedBrick } from '../decode/decoded_brick';
import { Codec } from '../gen/meniscus/v1/mesh_pb';
import { toScene, type UpAxis } from '../view/up_axis';
import { glbValues, type GlbValues } from './glb_values';
import { decodedForm } from './weld';

const short = 5122;
const unsignedShort = 5123;
const unsignedInt = 5125;
const float = 5126;
const triangles = 4;
const arrayBuffer = 34962;
const elementArrayBuffer = 34963;
const dracoExtension = 'KHR_draco_mesh_compression';
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
  const binary = new Binary();
  const meshes = bricks.map(({ encoded, decoded }) =>
    isDraco({ encoded, decoded }) ? dracoMesh(encoded, decoded, binary) : plainMesh(decoded, binary),
  );
  const valueViews = values?.bytes.map((part) => binary.add(part, { byteStride: values.stride, target: arrayBuffer }));
  return container(document(shown, bricks, meshes, values, valueViews, binary, up), binary.bytes());
}

/** The file's second part, as it grows. */
class Binary {
  readonly views: View[] = [];
  private readonly parts: Uint8Array[] = [];
  size = 0;

  /** The number of the part's view. */
  add(part: ArrayBufferView, properties: Pick<View, 'byteStride' | 'target'> = {}): number {
    this.parts.push(new Uint8Array(part.buffer, part.byteOffset, part.byteLength));
    this.views.push({ buffer: 0, byteOffset: this.size, byteLength: part.byteLength, ...properties });
    this.size = aligned(this.size + part.byteLength);
    return this.views.length - 1;
  }

  bytes(): Uint8Array {
    const bytes = new Uint8Array(this.size);
    this.parts.forEach((part, i) => {
      bytes.set(part, this.views[i]!.byteOffset);
    });
    return bytes;
  }
}

/** What a brick's accessors and its primitive have beside what all bricks' have. */
interface BrickMesh {
  readonly indices: object;
  readonly position: object;
  readonly normal: object;
  readonly primitive: object;
}

/** Whether its bytes are what glTF knows, and have all that is shown: computed normals they do not. */
function isDraco({ encoded, decoded }: ShownBrick): boolean {
  return encoded.codec === Codec.DRACO && !decoded.border;
}

function dracoMesh(encoded: EncodedBrick, decoded: DecodedBrick, binary: Binary): BrickMesh {
  const attributes = decoded.normals ? dracoIds : { POSITION: dracoIds.POSITION };
  const bufferView = binary.add(encoded.data);
  return {
    indices: { componentType: unsignedInt },
    position: {},
    normal: { componentType: float },
    primitive: { extensions: { [dracoExtension]: { bufferView, attributes } } },
  };
}

function plainMesh({ positions, normals, indices }: DecodedBrick, binary: Binary): BrickMesh {
  const addVectors = (vectors: ArrayBufferView): number => binary.add(vectors, { byteStride: 8, target: arrayBuffer });
  return {
    indices: {
      bufferView: binary.add(indices, { target: elementArrayBuffer }),
      componentType: indices instanceof Uint16Array ? unsignedShort : unsignedInt,
    },
    position: { bufferView: addVectors(positions) },
    normal: normals ? { bufferView: addVectors(normals), componentType: short, normalized: true } : {},
    primitive: {},
  };
}

function document(
  shown: Shown,
  bricks: ShownBrick[],
  brickMeshes: BrickMesh[],
  values: GlbValues | undefined,
  valueViews: number[] | undefined,
  binary: Binary,
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
    const brick = brickMeshes[i]!;
    const indices = add({ ...brick.indices, count: decoded.indices.length, type: 'SCALAR' });
    const POSITION = add({
      ...brick.position,
      componentType: unsignedShort,
      count: points,
      type: 'VEC3',
      min: decoded.bounds.min,
      max: decoded.bounds.max,
    });
    const normal = decoded.normals ? { NORMAL: add({ ...brick.normal, count: points, type: 'VEC3' }) } : {};
    const value = values
      ? {
          [values.name]: add({
            bufferView: valueViews![i],
            componentType: values.componentType,
            count: points,
            type: values.type,
          }),
        }
      : {};
    return {
      name: `brick ${encoded.place.join(' ')}`,
      primitives: [
        {
          attributes: { POSITION, ...normal, ...value },
          indices,
          material: 0,
          mode: triangles,
          ...brick.primitive,
        },
      ],
    };
  });
  const hasDraco = bricks.some(isDraco);
  const extensions = [...(hasDraco ? [dracoExtension] : []), 'KHR_mesh_quantization'];
  return {
    asset,
    extensionsUsed: extensions,
    extensionsRequired: extensions,
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
    bufferViews: binary.views,
    buffers: [{ byteLength: binary.size }],
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
