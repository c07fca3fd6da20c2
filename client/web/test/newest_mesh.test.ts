import { create } from '@bufbuild/protobuf';
import { describe, expect, it } from 'vitest';
import { WatchResponseSchema, type WatchResponse } from '../src/gen/meniscus/v1/surface_service_pb';
import { newestMesh } from '../src/list/newest_mesh';
import type { Received } from '../src/rpc/call';
import { Code, RpcError } from '../src/rpc/status';
import { begin, brick } from './support/messages';

describe('the mesh of a thumbnail', () => {
  /** A session whose surface has these numbers of triangles, and of bricks at each level that is asked for. */
  async function meshOf(triangles: bigint, bricksAt: Record<number, number>): Promise<[number[], number | undefined]> {
    const asked: number[] = [];
    async function* snapshot(maxLevel: number): AsyncGenerator<Received<WatchResponse>> {
      asked.push(maxLevel);
      const bricks = Array.from({ length: bricksAt[maxLevel] ?? 0 }, (_, x) => ({
        place: [x, 0, 0] as [number, number, number],
      }));
      const end = create(WatchResponseSchema, {
        message: { case: 'frameStatistics', value: { frameIndex: 1n, triangles } },
      });
      await Promise.resolve();
      for (const message of [begin({ index: 1, bricks }), ...bricks.map(({ place }) => brick(place)), end])
        yield { message, bytes: 1 };
    }
    const mesh = await newestMesh(snapshot);
    return [asked, mesh?.bricks.size];
  }

  it('is the coarsest that there is', async () => {
    expect(await meshOf(12n, { 1: 2, 3: 5 })).toEqual([[1], 2]);
  });

  it('is the whole surface where that leaves nothing of it', async () => {
    expect(await meshOf(12n, { 3: 5 })).toEqual([[1, 3], 5]);
  });

  it('is the whole surface of a session that has no coarser one', async () => {
    const asked: number[] = [];
    const refusing = (code: Code) =>
      newestMesh(async function* (maxLevel) {
        asked.push(maxLevel);
        await Promise.resolve();
        if (maxLevel < 3) throw new RpcError(code, 'made elsewhere');
        yield { message: begin({ index: 1, bricks: [] }), bytes: 1 };
        yield {
          message: create(WatchResponseSchema, {
            message: { case: 'frameStatistics', value: { frameIndex: 1n, triangles: 0n } },
          }),
          bytes: 1,
        };
      });
    expect((await refusing(Code.failedPrecondition))?.bricks.size).toBe(0);
    expect(asked).toEqual([1, 3]);
    await expect(refusing(Code.notFound)).rejects.toThrow('made elsewhere');
  });

  it('is asked for once where there is no surface, or no mesh', async () => {
    expect(await meshOf(0n, {})).toEqual([[1], 0]);
    const asked: number[] = [];
    const none = await newestMesh(async function* (maxLevel) {
      asked.push(maxLevel);
      await Promise.resolve();
      yield* [];
    });
    expect([asked, none]).toEqual([[1], undefined]);
  });
});
