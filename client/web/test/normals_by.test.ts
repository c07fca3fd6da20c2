import { fromBinary } from '@bufbuild/protobuf';
import { describe, expect, it } from 'vitest';
import { normalWish } from '../src/bricks/normals_by';
import { Codec } from '../src/gen/meniscus/v1/mesh_pb';
import { SnapshotRequestSchema, WatchRequestSchema } from '../src/gen/meniscus/v1/surface_service_pb';
import { Server } from '../src/rpc/server';
import { body, trailers } from './support/grpc_web';

/** The bits of normals that calls for meshes ask for, by the page's address. */
async function askedBits(search: string): Promise<(number | undefined)[]> {
  const asked: (number | undefined)[] = [];
  const fetch = (input: RequestInfo | URL, init?: RequestInit): Promise<Response> => {
    const schema = (input as string).endsWith('Watch') ? WatchRequestSchema : SnapshotRequestSchema;
    asked.push(fromBinary(schema, (init!.body as Uint8Array).subarray(5)).normalBits);
    return Promise.resolve(body(trailers('grpc-status: 0\r\n')));
  };
  const server = new Server({ base: '', fetch }, [Codec.DRACO], normalWish({ search }));
  const { signal } = new AbortController();
  for (const messages of [
    server.watch({ sessionId: 'one', normalBits: 7 }, signal, () => undefined),
    server.snapshot({ sessionId: 'one', maxLevel: 1 }, signal),
  ])
    for await (const { bytes } of messages) expect(bytes).toBeGreaterThan(0);
  return asked;
}

describe('normals', () => {
  it('are left to the viewer by the address: none are asked for', async () => {
    expect(await askedBits('?embed&normals-by=receiver')).toEqual([0, 0]);
  });

  it.each(['', '?normals-by=server', '?normals-by=', '?normals=receiver'])(
    'are asked for as the quality has it elsewhere: "%s"',
    async (search) => {
      expect(await askedBits(search)).toEqual([7, undefined]);
    },
  );
});
