// A mesh as binary PLY, as `meniscus` writes it: welded, with normals and a level per face.
import type { Shown } from '../bricks/brick_store';
import { weld } from './weld';

/** Beyond it single precision loses lattice positions. */
const singleLimit = 2 ** 23;

export function writePly(shown: Shown): Uint8Array {
  const { vertices, normals, triangles, levels } = weld(shown);
  const step = shown.frame.cellSize / 2 ** shown.frame.offsetBits;
  const wide = vertices.some((x) => Math.abs(x) >= singleLimit);
  const hasNormals = normals.length > 0;
  const vertexCount = vertices.length / 3;
  const header = new TextEncoder().encode(headerText(vertexCount, levels.length, wide, hasNormals));
  const coordinateBytes = wide ? 8 : 4;
  const file = new Uint8Array(
    header.length + vertexCount * (3 * coordinateBytes + (hasNormals ? 12 : 0)) + levels.length * 14,
  );
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
  }
  for (let triangle = 0; triangle < levels.length; ++triangle) {
    view.setUint8(at++, 3);
    for (let corner = 0; corner < 3; ++corner, at += 4) view.setUint32(at, triangles[3 * triangle + corner]!, true);
    view.setUint8(at++, levels[triangle]!);
  }
  return file;
}

function headerText(vertices: number, faces: number, wide: boolean, normals: boolean): string {
  const coordinates = ['x', 'y', 'z'].map((axis) => `property ${wide ? 'double' : 'float'} ${axis}\n`).join('');
  return (
    'ply\nformat binary_little_endian 1.0\ncomment Meniscus: face level 1, 2, 3; crack filling 0\n' +
    `element vertex ${vertices}\n${coordinates}` +
    (normals ? 'property float nx\nproperty float ny\nproperty float nz\n' : '') +
    `element face ${faces}\nproperty list uchar uint vertex_indices\nproperty uchar level\nend_header\n`
  );
}
