// A brick as the screen wants it.
import type { DecodedAttribute } from './attribute_values';

export const triangleLevels = ['level 1', 'level 2', 'level 3', 'crack filling'] as const;
export const levelCount = 4;

export interface DecodedBrick {
  /** Brick-local, in steps of cellSize / 2^offsetBits: x y z and a padding per point. */
  readonly positions: Uint16Array;
  /** Unit vectors times 32767: x y z and a padding per point; none if the mesh has none. */
  readonly normals: Int16Array | undefined;
  /** Of computed normals, which the bytes do not have. */
  readonly border?: NormalBorder;
  /** The one that was asked for; none if the brick does not carry it. */
  readonly attribute?: DecodedAttribute;
  /** Three points per triangle, ordered by level: 1, 2, 3, crack filling. */
  readonly indices: Uint16Array | Uint32Array;
  /** Triangles of each level, in that order. */
  readonly levelTriangles: readonly [number, number, number, number];
  /** Smallest and largest position on each axis. */
  readonly bounds: Bounds;
}

/** What a brick's own triangles give to the normals of points on its faces, which it shares with other bricks. */
export interface NormalBorder {
  readonly points: Uint32Array;
  /** Of each of them: the sum x y z over its triangles, and that over crack filling. */
  readonly sums: Float64Array;
}

export interface Bounds {
  readonly min: readonly [number, number, number];
  readonly max: readonly [number, number, number];
}

export function pointCount(brick: DecodedBrick): number {
  return brick.positions.length / 4;
}
