// Triangles in the order of their levels, so that each level is one range to draw.
import { levelCount, type DecodedBrick } from './decoded_brick';

export function groupTriangles(
  triangles: Uint32Array,
  groups: Uint8Array,
  points: number,
): Pick<DecodedBrick, 'indices' | 'levelTriangles'> {
  const levelTriangles: [number, number, number, number] = [0, 0, 0, 0];
  for (const group of groups) ++levelTriangles[group]!;
  const next = new Uint32Array(levelCount);
  for (let group = 1; group < levelCount; ++group) next[group] = next[group - 1]! + levelTriangles[group - 1]!;
  const indices = points <= 0xffff ? new Uint16Array(triangles.length) : new Uint32Array(triangles.length);
  for (let t = 0; t < groups.length; ++t) {
    const to = 3 * next[groups[t]!]!++;
    for (let corner = 0; corner < 3; ++corner) indices[to + corner] = triangles[3 * t + corner]!;
  }
  return { indices, levelTriangles };
}
