// The identity of a mesh in a binary PLY, as `meniscus` and the viewer write it.
import { createHash } from 'node:crypto';

const bytesOf = { float: 4, double: 8, uchar: 1, int: 4, uint: 4 };

/** SHA-256 of its triangles, each as its level and the places of its corners, whatever their order and that of vertices. */
export function hashOfPly(ply) {
  const end = 'end_header\n';
  const start = ply.indexOf(end) + end.length;
  const header = ply.subarray(0, start).toString('latin1');
  const [vertices, faces] = ['vertex', 'face'].map((name) =>
    Number(new RegExp(`element ${name} (\\d+)`).exec(header)[1]),
  );
  const [ofVertices, ofFaces] = header.slice(header.indexOf('element vertex')).split('element face');
  const properties = [...ofVertices.matchAll(/property (\w+) (\w+)/g)];
  if (!/property list uchar u?int vertex_indices\s+property uchar level\s+end_header/.test(ofFaces))
    throw new Error(`the faces of this PLY have another form: ${ofFaces}`);
  const coordinate = bytesOf[properties[0][1]];
  const vertexBytes = properties.reduce((sum, [, type]) => sum + bytesOf[type], 0);
  const placeOf = (vertex) => ply.subarray(start + vertex * vertexBytes, start + vertex * vertexBytes + 3 * coordinate);
  const triangles = [];
  let at = start + vertices * vertexBytes;
  for (let face = 0; face < faces; ++face) {
    if (ply[at] !== 3) throw new Error(`face ${face} has ${ply[at]} corners`);
    const corners = [1, 5, 9].map((offset) => placeOf(ply.readUInt32LE(at + offset)));
    const first = corners.reduce((least, corner, i) => (Buffer.compare(corner, corners[least]) < 0 ? i : least), 0);
    triangles.push(
      Buffer.concat([ply.subarray(at + 13, at + 14), ...[0, 1, 2].map((corner) => corners[(first + corner) % 3])]),
    );
    at += 14;
  }
  if (at !== ply.length) throw new Error(`the file has ${ply.length - at} bytes more than its faces`);
  return createHash('sha256')
    .update(Buffer.concat(triangles.sort(Buffer.compare)))
    .digest('hex');
}
