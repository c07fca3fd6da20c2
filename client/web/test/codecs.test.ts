import { create, fromBinary, toBinary } from '@bufbuild/protobuf';
import { describe, expect, it } from 'vitest';
import { wantedCodecs } from '../src/bricks/codecs';
import { Codec } from '../src/gen/meniscus/v1/mesh_pb';
import { GetServerInfoResponseSchema } from '../src/gen/meniscus/v1/server_service_pb';
import { WatchRequestSchema } from '../src/gen/meniscus/v1/surface_service_pb';
import { Server } from '../src/rpc/server';
import { body, message, trailers } from './support/grpc_web';

const { DRACO, LATTICE_PACKED, LATTICE_ENTROPY } = Codec;
const all = [LATTICE_ENTROPY, LATTICE_PACKED, DRACO];

describe('the codecs that are wanted', () => {
  it.each(['localhost', 'water.localhost', '127.0.0.1', '127.1.2.3', '[::1]'])(
    'are the fastest first on the machine of the server: %s',
    (hostname) => {
      expect(wantedCodecs({ hostname, search: '' }, all)).toEqual([LATTICE_PACKED, LATTICE_ENTROPY, DRACO]);
    },
  );

  it.each(['water.example', '10.0.0.1', '127.example', 'localhost.example', '[fe80::1]'])(
    'are the smallest first elsewhere: %s',
    (hostname) => {
      expect(wantedCodecs({ hostname, search: '' }, all)).toEqual([LATTICE_ENTROPY, LATTICE_PACKED, DRACO]);
    },
  );

  it.each([
    ['draco', [DRACO]],
    ['packed', [LATTICE_PACKED, DRACO]],
    ['entropy', [LATTICE_ENTROPY, DRACO]],
    ['toString', [LATTICE_ENTROPY, LATTICE_PACKED, DRACO]],
  ])('are those of the address: %s', (name, codecs) => {
    expect(wantedCodecs({ hostname: 'water.example', search: `?embed&codec=${name}` }, all)).toEqual(codecs);
  });

  it('are Draco alone without the decoder of the others', () => {
    for (const search of ['', '?codec=packed'])
      expect(wantedCodecs({ hostname: 'localhost', search }, [DRACO])).toEqual([DRACO]);
  });
});

/** A server that offers these, and what it is asked: calls by name, those for meshes with their codecs. */
function serverOf(offers: Codec[][], wanted: Codec[]): { server: Server; asked: string[] } {
  const asked: string[] = [];
  const server = new Server(
    {
      base: '',
      fetch: (input, init) => {
        if ((input as string).endsWith('GetServerInfo')) {
          asked.push('info');
          const info = create(GetServerInfoResponseSchema, { codecs: offers.shift() ?? [] });
          return Promise.resolve(
            body(message(0, toBinary(GetServerInfoResponseSchema, info)), trailers('grpc-status: 0\r\n')),
          );
        }
        const { codecs, sessionId } = fromBinary(WatchRequestSchema, (init!.body as Uint8Array).subarray(5));
        asked.push(codecs.join());
        return Promise.resolve(body(trailers(`grpc-status: ${sessionId === 'away' ? 14 : 0}\r\n`)));
      },
    },
    wanted,
  );
  return { server, asked };
}

async function watch(server: Server, sessionId: string): Promise<void> {
  const messages = server.watch({ sessionId }, new AbortController().signal, () => undefined);
  for await (const { bytes } of messages) expect(bytes).toBeGreaterThan(0);
}

describe('a call for meshes', () => {
  it('names the wanted codecs that the server offers, which is asked once', async () => {
    const { server, asked } = serverOf([[DRACO, LATTICE_PACKED]], all);
    await watch(server, 'one');
    await watch(server, 'two');
    expect(asked).toEqual(['info', '2,1', '2,1']);
  });

  it('names Draco to an older server, which refuses the others, and to one that says nothing', async () => {
    for (const offer of [[DRACO], []]) {
      const { server, asked } = serverOf([offer], all);
      await watch(server, 'one');
      expect(asked).toEqual(['info', '1']);
    }
  });

  it('asks anew after one that failed: another server may answer', async () => {
    const { server, asked } = serverOf([all, [DRACO]], all);
    await expect(watch(server, 'away')).rejects.toThrow();
    await watch(server, 'one');
    expect(asked).toEqual(['info', '3,2,1', 'info', '1']);
  });

  it('does not ask where Draco alone is wanted', async () => {
    const { server, asked } = serverOf([], [DRACO]);
    await watch(server, 'one');
    expect(asked).toEqual(['1']);
  });
});
