// A frame as it is kept: its bricks still encoded, shared with the frames before and after it where they did not change.
import type { CodedAttribute, VertexAttribute } from './attributes';
import type { Codec, FrameStatistics } from '../gen/meniscus/v1/mesh_pb';

export interface EncodedBrick {
  /** Place, in bricks. */
  readonly place: readonly [number, number, number];
  readonly vertexCount: number;
  readonly triangleCount: number;
  readonly cellLevels: Uint8Array;
  readonly codec: Codec;
  /** As the codec writes it. */
  readonly data: Uint8Array;
  /** The attributes that its vertices carry, in the codec's order. */
  readonly attributes: readonly CodedAttribute[];
}

/** Names a place in maps. */
export type BrickKey = string;

export function brickKey(x: number, y: number, z: number): BrickKey {
  return `${x},${y},${z}`;
}

/** A whole frame: immutable. */
export interface Frame {
  readonly index: bigint;
  readonly runId: bigint;
  readonly simulationTime: number;
  /** Edge of a finest cell, world units. */
  readonly cellSize: number;
  /** Vertices lie on multiples of cellSize / 2^offsetBits. */
  readonly offsetBits: number;
  /** Edge of a brick in finest cells. */
  readonly brickCells: number;
  readonly bricks: ReadonlyMap<BrickKey, EncodedBrick>;
  readonly triangleCount: number;
  /** The attributes of its vertices; the bricks carry those alone that were asked for. */
  readonly attributes: readonly VertexAttribute[];
  /** Particles that the surface leaves out: x y z each, world units. */
  readonly spray: Float32Array;
  readonly statistics: FrameStatistics;
  /** Received for this frame alone. */
  readonly bytes: number;
  /** When its first and its last message came, ms on the page's clock. */
  readonly beganAt: number;
  readonly arrivedAt: number;
}

/** Edge of a brick, world units. */
export function brickEdge(frame: Pick<Frame, 'brickCells' | 'cellSize'>): number {
  return frame.brickCells * frame.cellSize;
}
