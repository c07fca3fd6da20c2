// Normals of a brick that comes without, from its triangles: the rule of core/include/meniscus/mesh_normals.hpp. Points
// on the faces of the brick have triangles in other bricks, too: their sums are kept, to be joined with those
// (bricks/joined_normals.ts).
import { brickCells } from '../bricks/lattice';
import { pointCount, type DecodedBrick, type NormalBorder } from './decoded_brick';

/** Numbers per point of sums: x y z over its triangles, and over crack filling. */
export const sumSize = 6;

/**
 * Added and taken away, it rounds a number, at most 1, to a multiple of 2^-44. Such numbers add up without rounding: sums
 * do not depend on the order, and bricks that share a point find the same normal.
 */
const rounder = 384;

/** The brick as it is where it has normals; else with those that its own triangles show. */
export function withNormals(brick: DecodedBrick, offsetBits: number): DecodedBrick {
  if (brick.normals) return brick;
  const points = pointCount(brick);
  const sums = new Float64Array(points * sumSize);
  const { length } = brick.indices;
  const filling = length - 3 * brick.levelTriangles[3];
  const vertices = verticesOf(brick.positions);
  addTriangles(brick, vertices, 0, filling, sums, 0);
  addTriangles(brick, vertices, filling, length, sums, 3);
  const normals = new Int16Array(4 * points);
  for (let point = 0; point < points; ++point) normals.set(normalOf(sums, vertices[point]! * sumSize), 4 * point);
  return { ...brick, normals, border: borderOf(brick.positions, vertices, sums, brickCells << offsetBits) };
}

/** Of each point the first one in its place: Draco has several where parts of the surface touch. */
function verticesOf(positions: Uint16Array): Uint32Array {
  const vertices = new Uint32Array(positions.length / 4);
  const first = new Map<number, number>();
  for (let point = 0; point < vertices.length; ++point) {
    const key = placeKey(positions[4 * point]!, positions[4 * point + 1]!, positions[4 * point + 2]!);
    const known = first.get(key);
    if (known === undefined) first.set(key, point);
    vertices[point] = known ?? point;
  }
  return vertices;
}

/** Differs from place to place in a brick. */
export function placeKey(x: number, y: number, z: number): number {
  return x + 0x10000 * (y + 0x10000 * z);
}

/** Times 32767. at: where the point's sums begin. */
export function normalOf(sums: Float64Array, at: number): readonly [number, number, number] {
  const bare = sums[at] === 0 && sums[at + 1] === 0 && sums[at + 2] === 0;
  const from = bare ? at + 3 : at;
  const x = sums[from]!;
  const y = sums[from + 1]!;
  const z = sums[from + 2]!;
  const length = Math.sqrt(x * x + y * y + z * z);
  if (length === 0) return [0, 0, 32767];
  const scale = 32767 / length;
  return [Math.round(x * scale), Math.round(y * scale), Math.round(z * scale)];
}

/** indices from `begin` to `end`. offset: of the three numbers of a point's sums to which they are added. */
function addTriangles(
  { positions, indices }: DecodedBrick,
  vertices: Uint32Array,
  begin: number,
  end: number,
  sums: Float64Array,
  offset: number,
): void {
  for (let t = begin; t < end; t += 3) {
    const a = indices[t]!;
    const b = indices[t + 1]!;
    const c = indices[t + 2]!;
    // From each corner to the next.
    const ex = positions[4 * b]! - positions[4 * a]!;
    const ey = positions[4 * b + 1]! - positions[4 * a + 1]!;
    const ez = positions[4 * b + 2]! - positions[4 * a + 2]!;
    const fx = positions[4 * c]! - positions[4 * b]!;
    const fy = positions[4 * c + 1]! - positions[4 * b + 1]!;
    const fz = positions[4 * c + 2]! - positions[4 * b + 2]!;
    const gx = positions[4 * a]! - positions[4 * c]!;
    const gy = positions[4 * a + 1]! - positions[4 * c + 1]!;
    const gz = positions[4 * a + 2]! - positions[4 * c + 2]!;
    const ee = ex * ex + ey * ey + ez * ez;
    const ff = fx * fx + fy * fy + fz * fz;
    const gg = gx * gx + gy * gy + gz * gz;
    if (ee === 0 || ff === 0 || gg === 0) continue;
    const nx = ey * fz - ez * fy;
    const ny = ez * fx - ex * fz;
    const nz = ex * fy - ey * fx;
    const add = (point: number, weight: number): void => {
      const at = vertices[point]! * sumSize + offset;
      sums[at] = sums[at]! + (nx * weight + rounder - rounder);
      sums[at + 1] = sums[at + 1]! + (ny * weight + rounder - rounder);
      sums[at + 2] = sums[at + 2]! + (nz * weight + rounder - rounder);
    };
    add(a, 1 / (ee * gg));
    add(b, 1 / (ff * ee));
    add(c, 1 / (gg * ff));
  }
}

function borderOf(positions: Uint16Array, vertices: Uint32Array, sums: Float64Array, last: number): NormalBorder {
  const points: number[] = [];
  for (let point = 0; 4 * point < positions.length; ++point)
    for (let axis = 0; axis < 3; ++axis) {
      const place = positions[4 * point + axis]!;
      if (place !== 0 && place !== last) continue;
      points.push(point);
      break;
    }
  const own = new Float64Array(points.length * sumSize);
  points.forEach((point, i) => {
    const at = vertices[point]! * sumSize;
    own.set(sums.subarray(at, at + sumSize), i * sumSize);
  });
  return { points: Uint32Array.from(points), sums: own };
}
