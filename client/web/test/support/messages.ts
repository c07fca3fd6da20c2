// Watch responses as a server would send them.
import { create, type MessageInitShape } from '@bufbuild/protobuf';
import { Codec, type MeshAttributeSchema } from '../../src/gen/meniscus/v1/mesh_pb';
import { WatchResponseSchema, type WatchResponse } from '../../src/gen/meniscus/v1/surface_service_pb';

export type Place = [number, number, number];

export interface FrameOptions {
  index: number;
  bricks?: { place: Place; triangles?: number; parts?: number[][] }[];
  base?: number;
  vanished?: Place[];
  /** The triangles of the whole mesh as the receiver then has it. */
  triangles?: number;
  /** x y z of each point, by message. */
  spray?: number[][];
  sprayCount?: number;
  runId?: bigint;
  attributes?: MessageInitShape<typeof MeshAttributeSchema>[];
}

export function begin(options: FrameOptions): WatchResponse {
  const { index, bricks = [], base, vanished = [], triangles, spray = [], runId = 7n } = options;
  return create(WatchResponseSchema, {
    message: {
      case: 'meshBegin',
      value: {
        frameIndex: BigInt(index),
        simulationTime: index / 100,
        cellSize: 0.5,
        offsetBits: 6,
        brickCells: 64,
        brickCount: bricks.length,
        ...(base === undefined ? {} : { baseFrameIndex: BigInt(base) }),
        vanished: vanished.map(([x, y, z]) => ({ x, y, z })),
        triangleCount: BigInt(triangles ?? bricks.reduce((sum, brick) => sum + (brick.triangles ?? 1), 0)),
        runId,
        attributes: options.attributes ?? [],
        sprayCount: BigInt(options.sprayCount ?? spray.flat().length / 3),
      },
    },
  });
}

export function sprayPoints(positions: number[]): WatchResponse {
  return create(WatchResponseSchema, {
    message: { case: 'sprayPoints', value: { positions: new Uint8Array(new Float32Array(positions).buffer) } },
  });
}

export function brick(
  place: Place,
  triangles = 1,
  data: number[] = [1, 2, 3],
  partIndex = 0,
  partCount = 1,
  codec = Codec.DRACO,
): WatchResponse {
  const [x, y, z] = place;
  return create(WatchResponseSchema, {
    message: {
      case: 'meshBrick',
      value: {
        x,
        y,
        z,
        vertexCount: 3,
        triangleCount: triangles,
        codec,
        data: new Uint8Array(data),
        partIndex,
        partCount,
      },
    },
  });
}

export function statistics(index: number): WatchResponse {
  return create(WatchResponseSchema, { message: { case: 'frameStatistics', value: { frameIndex: BigInt(index) } } });
}

export function draining(seconds: number): WatchResponse {
  return create(WatchResponseSchema, { message: { case: 'draining', value: { seconds } } });
}

/** All messages of a frame. */
export function frame(options: FrameOptions): WatchResponse[] {
  const bricks = (options.bricks ?? []).flatMap(({ place, triangles, parts = [[options.index]] }) =>
    parts.map((bytes, part) => brick(place, triangles, bytes, part, parts.length)),
  );
  return [begin(options), ...bricks, ...(options.spray ?? []).map(sprayPoints), statistics(options.index)];
}
