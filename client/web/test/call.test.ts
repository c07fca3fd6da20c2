import { create, toBinary } from '@bufbuild/protobuf';
import { describe, expect, it, vi } from 'vitest';
import { Codec } from '../src/gen/meniscus/v1/mesh_pb';
import { WatchRequestSchema, WatchResponseSchema } from '../src/gen/meniscus/v1/surface_service_pb';
import { Server } from '../src/rpc/server';
import { Code, explain, RpcError } from '../src/rpc/status';
import { body, grpcWeb, message, trailers } from './support/grpc_web';
import { draining } from './support/messages';

function serverThat(answer: (input: string, init: RequestInit) => Response | Promise<Response>): Server {
  return new Server({ base: 'http://host', fetch: async (input, init) => answer(input as string, init!) }, [
    Codec.DRACO,
  ]);
}

async function watchAll(server: Server, signal = new AbortController().signal): Promise<number> {
  let count = 0;
  for await (const received of server.watch({ sessionId: 'an-id', normalBits: 0 }, signal, () => undefined))
    count += received.bytes > 0 ? 1 : 0;
  return count;
}

async function failure(call: Promise<unknown>): Promise<RpcError> {
  const error: unknown = await call.then(
    () => undefined,
    (reason: unknown) => reason,
  );
  expect(error).toBeInstanceOf(RpcError);
  return error as RpcError;
}

describe('a call', () => {
  it('posts the framed request to the method, with session, token and content type', async () => {
    let seen: { input: string; init: RequestInit } | undefined;
    const server = serverThat((input, init) => {
      seen = { input, init };
      return body(trailers('grpc-status: 0\r\n'));
    });
    server.token = 'secret';
    await watchAll(server);
    expect(seen!.input).toBe('http://host/meniscus.v1.SurfaceService/Watch');
    expect(seen!.init.method).toBe('POST');
    expect(seen!.init.headers).toMatchObject({
      'content-type': 'application/grpc-web+proto',
      'x-session-id': 'an-id',
      authorization: 'Bearer secret',
    });
    const request = toBinary(
      WatchRequestSchema,
      create(WatchRequestSchema, { sessionId: 'an-id', normalBits: 0, codecs: [Codec.DRACO], withSpray: true }),
    );
    expect(seen!.init.body).toEqual(message(0, request));
  });

  it('yields the messages and ends with the trailers', async () => {
    const response = toBinary(WatchResponseSchema, draining(3));
    const server = serverThat(() => body(message(0, response), message(0, response), trailers('grpc-status:0\r\n')));
    expect(await watchAll(server)).toBe(2);
  });

  it('throws the status of the trailers, its text decoded', async () => {
    const server = serverThat(() => body(trailers('grpc-status: 5\r\ngrpc-message: no session %22x%22\r\n')));
    const error = await failure(watchAll(server));
    expect([error.code, error.message]).toEqual([Code.notFound, 'no session "x"']);
  });

  it('throws the status of the headers where there is no body', async () => {
    const server = serverThat(
      () => new Response(null, { headers: { ...grpcWeb, 'grpc-status': '16', 'grpc-message': 'no token' } }),
    );
    expect((await failure(server.info())).code).toBe(Code.unauthenticated);
  });

  it('explains a token that the server does not know in other words than a missing one', async () => {
    const refusal = { ...grpcWeb, 'grpc-status': '16', 'grpc-message': 'no' };
    const server = serverThat(() => new Response(null, { headers: refusal }));
    expect(explain(await failure(server.info()))).toBe('The server asks for a token.');
    server.token = 'wrong';
    expect(explain(await failure(server.info()))).toBe('The server does not know this token.');
    expect(explain(await failure(watchAll(server)))).toBe('The server does not know this token.');
  });

  it('maps what is no gRPC-Web answer', async () => {
    const codeFor = async (response: Response): Promise<Code> =>
      (await failure(serverThat(() => response).info())).code;
    expect(await codeFor(new Response('down', { status: 503 }))).toBe(Code.unavailable);
    expect(await codeFor(new Response('who', { status: 401 }))).toBe(Code.unauthenticated);
    expect(await codeFor(new Response('<html>', { headers: { 'content-type': 'text/html' } }))).toBe(
      Code.unimplemented,
    );
    expect(await codeFor(body(trailers('grpc-status: 0\r\n')))).toBe(Code.internal);
  });

  it('says that the server is unavailable when the connection fails or ends early', async () => {
    const unreachable = serverThat(() => Promise.reject(new TypeError('fetch failed')));
    expect((await failure(unreachable.info())).code).toBe(Code.unavailable);
    const cut = serverThat(() => body(message(0, toBinary(WatchResponseSchema, draining(1)))));
    expect((await failure(watchAll(cut))).code).toBe(Code.unavailable);
    const torn = serverThat(() => body(trailers('grpc-status: 0\r\n').slice(0, 9)));
    expect((await failure(watchAll(torn))).message).toContain('within a message');
  });

  it.each([
    ['grpc-status:0\r\nx-session-end: it was deleted\r\n', 'it was deleted'],
    ['grpc-status:0\r\n', ''],
  ])('says why the session ended that it watched: %j', async (text, reason) => {
    const server = serverThat(() => body(trailers(text)));
    const ended = vi.fn();
    const { signal } = new AbortController();
    for await (const received of server.watch({ sessionId: 'an-id' }, signal, () => undefined, ended))
      expect(received).toBeUndefined();
    expect(ended).toHaveBeenCalledExactlyOnceWith(reason);
  });

  it('ends its request when the reader leaves', async () => {
    let canceled = false;
    const stream = new ReadableStream<Uint8Array>({
      start(controller) {
        controller.enqueue(message(0, toBinary(WatchResponseSchema, draining(1))));
      },
      cancel() {
        canceled = true;
      },
    });
    const server = serverThat(() => new Response(stream, { headers: grpcWeb }));
    for await (const received of server.watch({ sessionId: 'x' }, new AbortController().signal, () => undefined)) {
      expect(received.message.message.case).toBe('draining');
      break;
    }
    expect(canceled).toBe(true);
  });
});
