import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import type { Frame } from '../src/bricks/frame';
import type { WatchResponse } from '../src/gen/meniscus/v1/surface_service_pb';
import type { Received } from '../src/rpc/call';
import { Code, RpcError } from '../src/rpc/status';
import { SessionWatch, type WatchServer, type WatchOptions } from '../src/stream/session_watch';
import type { WatchState } from '../src/stream/watch_state';
import { begin, draining, frame } from './support/messages';

/** One call, as the server's side of it. */
class Call {
  private readonly queue: (() => WatchResponse | undefined)[] = [];
  private wake: () => void = () => undefined;

  constructor(
    readonly request: WatchOptions,
    readonly signal: AbortSignal,
    readonly open: () => void,
    readonly explain: (reason: string) => void,
  ) {}

  async send(...messages: WatchResponse[]): Promise<void> {
    for (const message of messages) this.push(() => message);
    await vi.advanceTimersByTimeAsync(0);
  }
  async end(error?: Error): Promise<void> {
    this.push(() => {
      if (error) throw error;
      return undefined;
    });
    await vi.advanceTimersByTimeAsync(0);
  }
  async *messages(): AsyncGenerator<Received<WatchResponse>, void> {
    for (;;) {
      while (this.queue.length === 0) await new Promise<void>((resolve) => (this.wake = resolve));
      const message = this.queue.shift()!();
      if (!message) return;
      yield { message, bytes: 1 };
    }
  }
  private push(step: () => WatchResponse | undefined): void {
    this.queue.push(step);
    this.wake();
  }
}

class FakeServer implements WatchServer {
  readonly calls: Call[] = [];
  watch(
    request: WatchOptions & { sessionId: string },
    signal: AbortSignal,
    opened: () => void,
    ended: (reason: string) => void,
  ): AsyncIterable<Received<WatchResponse>> {
    const call = new Call(request, signal, opened, ended);
    this.calls.push(call);
    return call.messages();
  }
  get last(): Call {
    return this.calls.at(-1)!;
  }
}

describe('SessionWatch', () => {
  let server: FakeServer;
  let frames: Frame[];
  let states: WatchState[];
  let watch: SessionWatch;

  beforeEach(() => {
    vi.useFakeTimers();
    server = new FakeServer();
    frames = [];
    states = [];
    watch = new SessionWatch(
      server,
      'an-id',
      {},
      {
        frame: (next) => frames.push(next),
        state: (state) => states.push(state),
        received: () => undefined,
      },
    );
    watch.start();
  });
  afterEach(() => {
    watch.stop();
    vi.useRealTimers();
  });

  const state = (): WatchState => states.at(-1)!;
  const unavailable = new RpcError(Code.unavailable, 'gone');

  it('passes frames on and says once that it is live', async () => {
    await server.last.send(...frame({ index: 1 }), ...frame({ index: 2, base: 1 }));
    expect(frames.map(({ index }) => index)).toEqual([1n, 2n]);
    expect(states.map(({ kind }) => kind)).toEqual(['connecting', 'live']);
  });

  it('asks for whole surfaces from then on where a session has no coarser ones', async () => {
    const madeElsewhere = new RpcError(Code.failedPrecondition, 'made elsewhere');
    watch.setOptions({ maxLevel: 2, normalBits: 6 });
    expect(server.last.request).toMatchObject({ maxLevel: 2 });
    await server.last.end(madeElsewhere);
    expect(server.last.request).not.toHaveProperty('maxLevel');
    expect(server.last.request).toMatchObject({ normalBits: 6 });
    watch.setOptions({ maxLevel: 2 });
    expect(server.last.request).not.toHaveProperty('maxLevel');
    await server.last.send(...frame({ index: 1 }));
    expect(state().kind).toBe('live');
    await server.last.end(madeElsewhere);
    expect(state().kind).toBe('refused');
  });

  it('has another state for a session without a mesh than for a server that does not answer', async () => {
    expect(state().kind).toBe('connecting');
    server.last.open();
    expect(state().kind).toBe('connected');
    await server.last.send(...frame({ index: 1 }));
    expect(state().kind).toBe('live');
    const old = server.last;
    watch.setPaused(true);
    old.open();
    expect(state().kind).toBe('paused');
  });

  it('connects again by itself after the time that it reports, and starts from a whole mesh', async () => {
    await server.last.send(...frame({ index: 1 }), begin({ index: 2, base: 1 }));
    await server.last.end(unavailable);
    const waiting = state();
    if (waiting.kind !== 'waiting') throw new Error(`it is ${waiting.kind}`);
    expect(waiting.reason).toContain('cannot be reached');
    await vi.advanceTimersByTimeAsync(waiting.retryAt - performance.now() - 1);
    expect(server.calls).toHaveLength(1);
    await vi.advanceTimersByTimeAsync(2);
    expect(server.calls).toHaveLength(2);
    await server.last.send(...frame({ index: 3 }));
    expect(frames.map(({ index }) => index)).toEqual([1n, 3n]);
  });

  it('waits longer from attempt to attempt, and less again after a frame', async () => {
    const waits: number[] = [];
    const failOnce = async (): Promise<void> => {
      await server.last.end(unavailable);
      const waiting = state();
      if (waiting.kind !== 'waiting') throw new Error(`it is ${waiting.kind}`);
      waits.push(waiting.retryAt - performance.now());
      await vi.advanceTimersByTimeAsync(waits.at(-1)!);
    };
    for (let i = 0; i < 8; ++i) await failOnce();
    expect(Math.max(...waits)).toBeLessThanOrEqual(1000);
    expect(waits[7]).toBeGreaterThanOrEqual(500);
    await server.last.send(...frame({ index: 1 }));
    await failOnce();
    expect(waits[8]).toBeLessThanOrEqual(250);
  });

  it('never goes back within a run, whatever a new call brings', async () => {
    await server.last.send(...frame({ index: 5 }));
    await server.last.end(unavailable);
    await vi.advanceTimersByTimeAsync(10_000);
    await server.last.send(...frame({ index: 4 }), ...frame({ index: 5, base: 4 }), ...frame({ index: 6, base: 5 }));
    await server.last.send(...frame({ index: 1, runId: 8n }));
    expect(frames.map(({ index }) => index)).toEqual([5n, 5n, 6n, 1n]);
  });

  it('asks anew when its options change, and takes nothing more of the old call', async () => {
    await server.last.send(...frame({ index: 1 }));
    const old = server.last;
    watch.setOptions({ positionBits: 3 });
    expect(old.signal.aborted).toBe(true);
    expect(server.last.request).toMatchObject({ positionBits: 3, sessionId: 'an-id' });
    await old.send(...frame({ index: 2, base: 1 }));
    await old.end(unavailable);
    await server.last.send(...frame({ index: 3 }));
    expect(frames.map(({ index }) => index)).toEqual([1n, 3n]);
    expect(state().kind).toBe('live');
  });

  it('stops asking while paused and asks again afterwards', async () => {
    watch.setPaused(true);
    expect(server.last.signal.aborted).toBe(true);
    expect(state().kind).toBe('paused');
    await vi.advanceTimersByTimeAsync(60_000);
    expect(server.calls).toHaveLength(1);
    watch.setPaused(false);
    expect(server.calls).toHaveLength(2);
  });

  it('does not try again while paused in the middle of a countdown', async () => {
    await server.last.end(unavailable);
    watch.setPaused(true);
    await vi.advanceTimersByTimeAsync(60_000);
    expect(server.calls).toHaveLength(1);
  });

  it('passes on that the server goes down', async () => {
    await server.last.send(draining(4));
    expect(state()).toEqual({ kind: 'draining', seconds: 4 });
  });

  it.each([
    ['absent', new RpcError(Code.notFound, 'no such session')],
    ['waiting', new RpcError(Code.resourceExhausted, '8 watchers, at most 8')],
    ['waiting', new RpcError(Code.internal, 'its GPU failed')],
    ['token', new RpcError(Code.unauthenticated, 'no token')],
    ['token', new RpcError(Code.permissionDenied, 'not a watcher')],
    ['refused', new RpcError(Code.invalidArgument, 'normal_bits is 99')],
    ['refused', new Error('torn')],
  ])('is %s after %s', async (kind, error) => {
    await server.last.end(error);
    expect(state().kind).toBe(kind);
    await vi.advanceTimersByTimeAsync(60_000);
    expect(server.calls.length > 1).toBe(kind === 'waiting' || kind === 'absent');
  });

  it('keeps reporting when the session ended and why, also to a paused page, and after the server was out of reach', async () => {
    await server.last.send(...frame({ index: 1 }));
    server.last.explain('it was deleted');
    await server.last.end();
    const ended = state();
    expect(ended).toMatchObject({ kind: 'ended', reason: 'it was deleted' });
    watch.setPaused(true);
    expect(state()).toEqual(ended);
    watch.setPaused(false);
    expect(state()).toEqual(ended);
    await server.last.end(unavailable);
    expect(state().kind).toBe('waiting');
    await vi.advanceTimersByTimeAsync(8000);
    await server.last.end(new RpcError(Code.notFound, 'no such session'));
    expect(state()).toEqual(ended);
  });

  it('says that the session has ended, and shows it again when its simulator makes it again', async () => {
    await server.last.send(...frame({ index: 1 }));
    await server.last.end();
    for (let attempt = 2; attempt < 5; ++attempt) {
      expect(state().kind).toBe('ended');
      await vi.advanceTimersByTimeAsync(8000);
      expect(server.calls).toHaveLength(attempt);
      await server.last.end(new RpcError(Code.notFound, 'no such session'));
    }
    await vi.advanceTimersByTimeAsync(8000);
    await server.last.send(...frame({ index: 0, runId: 9n }));
    expect(state().kind).toBe('live');
    expect(frames.map(({ index }) => index)).toEqual([1n, 0n]);
  });

  it('refuses a server that contradicts itself, in words', async () => {
    await server.last.send(begin({ index: 2, base: 1 }));
    expect(state()).toMatchObject({ kind: 'refused' });
  });
});
