// A mesh as binary PLY, as `meniscus` writes it: welded, with normals, what the surface is colored by, and a level per face.
import type { AttributeForm, ElementType } from '../bricks/attributes';
import type { Shown } from '../bricks/brick_store';
import { weld } from './weld';

/** Beyond it single precision loses lattice positions. */
const singleLimit = 2 ** 23;

/** PLY's names, and bytes. */
const numbers: Record<ElementType, { readonly name: string; readonly bytes: number }> = {
  float32: { name: 'float', bytes: 4 },
  uint8: { name: 'uchar', bytes: 1 },
  int32: { name: 'int', bytes: 4 },
  uint32: { name: 'uint', bytes: 4 },
};

export function writePly(shown: Shown): Uint8Array {
  const { vertices, normals, triangles, levels, attribute } = weld(shown);
  const step = shown.frame.cellSize / 2 ** shown.frame.offsetBits;
  const wide = vertices.some((x) => Math.abs(x) >= singleLimit);
  const hasNormals = normals.length > 0;
  const vertexCount = vertices.length / 3;
  const header = new TextEncoder().encode(headerText(vertexCount, levels.length, wide, hasNormals, attribute?.form));
  const coordinateBytes = wide ? 8 : 4;
  const number = numbers[attribute?.form.type ?? 'float32'];
  const components = attribute?.form.components ?? 0;
  const vertexBytes = 3 * coordinateBytes + (hasNormals ? 12 : 0) + components * number.bytes;
  const file = new Uint8Array(header.length + vertexCount * vertexBytes + levels.length * 14);
  file.set(header);
  const view = new DataView(file.buffer);
  let at = header.length;
  for (let vertex = 0; vertex < vertexCount; ++vertex) {
    for (let axis = 0; axis < 3; ++axis, at += coordinateBytes) {
      const x = vertices[3 * vertex + axis]! * step;
      if (wide) view.setFloat64(at, x, true);
      else view.setFloat32(at, x, true);
    }
    if (hasNormals)
      for (let axis = 0; axis < 3; ++axis, at += 4) view.setFloat32(at, normals[3 * vertex + axis]! / 32767, true);
    for (let component = 0; component < components; ++component, at += number.bytes)
      writeNumber(view, at, attribute!.form.type, attribute!.values[components * vertex + component]!);
  }
  for (let triangle = 0; triangle < levels.length; ++triangle) {
    view.setUint8(at++, 3);
    for (let corner = 0; corner < 3; ++corner, at += 4) view.setUint32(at, triangles[3 * triangle + corner]!, true);
    view.setUint8(at++, levels[triangle]!);
  }
  return file;
}

function writeNumber(view: DataView, at: number, type: ElementType, value: number): void {
  switch (type) {
    case 'float32':
      view.setFloat32(at, value, true);
      return;
    case 'uint8':
      view.setUint8(at, value);
      return;
    case 'int32':
      view.setInt32(at, value, true);
      return;
    case 'uint32':
      view.setUint32(at, value, true);
  }
}

function headerText(
  vertices: number,
  faces: number,
  wide: boolean,
  normals: boolean,
  attribute: AttributeForm | undefined,
): string {
  const coordinates = ['x', 'y', 'z'].map((axis) => `property ${wide ? 'double' : 'float'} ${axis}\n`).join('');
  return (
    'ply\nformat binary_little_endian 1.0\ncomment Meniscus: face level 1, 2, 3; crack filling 0\n' +
    `element vertex ${vertices}\n${coordinates}` +
    (normals ? 'property float nx\nproperty float ny\nproperty float nz\n' : '') +
    (attribute ? propertiesOf(attribute) : '') +
    `element face ${faces}\nproperty list uchar uint vertex_indices\nproperty uchar level\nend_header\n`
  );
}

const taken = ['x', 'y', 'z', 'nx', 'ny', 'nz', 'level'];

/** A number has its attribute's name, with a _ where that means something else; of several, each has its component's. */
function propertiesOf({ name, type, components }: AttributeForm): string {
  const colors = type === 'uint8' && name === 'color';
  const names =
    components === 1
      ? [taken.includes(name) ? `${name}_` : name]
      : (colors ? ['red', 'green', 'blue', 'alpha'] : ['x', 'y', 'z', 'w'].map((axis) => `${name}_${axis}`)).slice(
          0,
          components,
        );
  return names.map((each) => `property ${numbers[type].name} ${each}\n`).join('');
}
