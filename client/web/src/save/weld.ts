// The bricks as one mesh: a vertex's position on the lattice is its identity.
import type { AttributeForm } from '../bricks/attributes';
import type { Shown, ShownBrick } from '../bricks/brick_store';
import { brickKey, type BrickKey, type EncodedBrick } from '../bricks/frame';
import { pointCount, type DecodedBrick } from '../decode/decoded_brick';

export interface WeldedMesh {
  /** x y z on the lattice refined by 2^offsetBits. */
  readonly vertices: number[];
  /** x y z, times 32767; empty if some brick has none. */
  readonly normals: number[];
  readonly triangles: number[];
  /** The level of each triangle: 1, 2, 3; crack filling 0. */
  readonly levels: number[];
  /** The attribute that was decoded for all vertices: its numbers, one vertex after the other. */
  readonly attribute: { readonly form: AttributeForm; readonly values: number[] } | undefined;
}

export function weld({ frame, bricks }: Shown): WeldedMesh {
  const form = decodedForm([...bricks.values()], frame.attributes);
  const attribute = form && { form, values: new Array<number>() };
  const mesh: WeldedMesh = { vertices: [], normals: [], triangles: [], levels: [], attribute };
  const hasNormals = [...bricks.values()].every(({ decoded }) => decoded.normals !== undefined);
  const numbers = new VertexNumbers(frame.brickCells << frame.offsetBits);
  for (const { encoded, decoded } of bricks.values()) {
    const ofPoint = new Uint32Array(pointCount(decoded));
    for (let point = 0; point < ofPoint.length; ++point) {
      const { number, fresh } = numbers.find(encoded, decoded, point);
      ofPoint[point] = number;
      if (!fresh) continue;
      for (let axis = 0; axis < 3; ++axis) {
        mesh.vertices.push(encoded.place[axis]! * numbers.edge + decoded.positions[4 * point + axis]!);
        if (hasNormals) mesh.normals.push(decoded.normals![4 * point + axis]!);
      }
      if (attribute) {
        const { components } = form;
        attribute.values.push(...decoded.attribute!.values.subarray(components * point, components * (point + 1)));
      }
    }
    for (const point of decoded.indices) mesh.triangles.push(ofPoint[point]!);
    decoded.levelTriangles.forEach((count, group) => {
      for (let i = 0; i < count; ++i) mesh.levels.push((group + 1) % 4);
    });
  }
  return mesh;
}

/** The form of the attribute that every brick was decoded with; none if there is none. */
export function decodedForm(
  bricks: readonly ShownBrick[],
  announced: readonly AttributeForm[],
): AttributeForm | undefined {
  const name = bricks[0]?.decoded.attribute?.name;
  if (name === undefined || bricks.some(({ decoded }) => decoded.attribute?.name !== name)) return undefined;
  return announced.find((form) => form.name === name);
}

/** A vertex on a face that bricks share is looked up in the brick above, so that each has one place to be found. */
class VertexNumbers {
  private readonly owners = new Map<BrickKey, Map<number, number>>();
  private count = 0;

  /** edge: of a brick, in steps of the refined lattice. */
  constructor(readonly edge: number) {}

  find({ place }: EncodedBrick, { positions }: DecodedBrick, point: number): { number: number; fresh: boolean } {
    const owner: [number, number, number] = [...place];
    let key = 0;
    for (let axis = 0; axis < 3; ++axis) {
      let local = positions[4 * point + axis]!;
      if (local === this.edge) {
        local = 0;
        ++owner[axis]!;
      }
      key = key * this.edge + local;
    }
    const ownerKey = brickKey(...owner);
    let vertices = this.owners.get(ownerKey);
    if (!vertices) this.owners.set(ownerKey, (vertices = new Map<number, number>()));
    const known = vertices.get(key);
    if (known !== undefined) return { number: known, fresh: false };
    vertices.set(key, this.count);
    return { number: this.count++, fresh: true };
  }
}
