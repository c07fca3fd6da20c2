import { create } from '@bufbuild/protobuf';
import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import {
  ElementType,
  WatchParticlesResponseSchema,
  type WatchParticlesResponse,
} from '../src/gen/meniscus/v1/surface_service_pb';
import { KeptParticles } from '../src/particles/kept_particles';
import { ParticleReceiver } from '../src/particles/particle_receiver';
import type { Particles } from '../src/particles/particles';
import type { Received } from '../src/rpc/call';
import { Code, RpcError } from '../src/rpc/status';
import { maxParticles, ParticleWatch, type ParticleServer } from '../src/stream/particle_watch';

type Listed = [name: string, type: ElementType, components: number];
const position: Listed = ['position', ElementType.UINT16, 3];
const level: Listed = ['level', ElementType.UINT8, 1];

interface Header {
  index?: number;
  count?: number;
  arrays?: Listed[];
  radius?: number;
  max?: number;
}

function begin({
  index = 3,
  count = 2,
  arrays = [position],
  radius = 0.5,
  max = 1,
}: Header = {}): WatchParticlesResponse {
  return create(WatchParticlesResponseSchema, {
    message: {
      case: 'particlesBegin',
      value: {
        frameIndex: BigInt(index),
        runId: 7n,
        particleCount: BigInt(2 * count),
        stride: 2n,
        sentCount: BigInt(count),
        arrays: arrays.map(([name, type, components]) => ({ name, type, components })),
        particleRadius: radius,
        quantizationBox: { min: { x: 0, y: -1, z: 0 }, max: { x: max, y: 1, z: 1 } },
      },
    },
  });
}

function chunk(...data: number[]): WatchParticlesResponse {
  return create(WatchParticlesResponseSchema, {
    message: { case: 'frameChunk', value: { data: new Uint8Array(data) } },
  });
}

function end(): WatchParticlesResponse {
  return create(WatchParticlesResponseSchema, { message: { case: 'frameEnd', value: {} } });
}

function take(...messages: WatchParticlesResponse[]): Particles | undefined {
  const receiver = new ParticleReceiver();
  return messages.map((message) => receiver.take(message)).at(-1);
}

const positions = [1, 0, 2, 0, 3, 0, 4, 0, 5, 0, 6, 1];

describe('ParticleReceiver', () => {
  it('puts pieces together wherever they are cut', () => {
    const bytes = [...positions, 0, 3];
    for (let cut = 0; cut <= bytes.length; ++cut) {
      const particles = take(
        begin({ arrays: [position, level] }),
        chunk(...bytes.slice(0, cut)),
        chunk(...bytes.slice(cut)),
        end(),
      )!;
      expect([...particles.positions]).toEqual([1, 2, 3, 4, 5, 262]);
      expect([...particles.levels!]).toEqual([0, 3]);
      expect([particles.index, particles.frameCount, particles.stride, particles.min[1]]).toEqual([3n, 4, 2, -1]);
    }
  });

  it('skips arrays that it does not know', () => {
    const arrays: Listed[] = [position, ['velocity', ElementType.FLOAT32, 3], level, ['id', ElementType.UINT32, 1]];
    const bytes = [...positions, ...new Array<number>(24).fill(9), 0, 3, ...new Array<number>(8).fill(9)];
    const particles = take(begin({ arrays }), chunk(...bytes), end())!;
    expect([...particles.positions]).toEqual([1, 2, 3, 4, 5, 262]);
    expect([...particles.levels!]).toEqual([0, 3]);
  });

  it('forgets a frame that is abandoned', () => {
    expect(take(begin({ index: 1 }), chunk(1), begin({ index: 2 }), chunk(...positions), end())?.index).toBe(2n);
  });

  it.each<[string, WatchParticlesResponse[]]>([
    ['outside of a frame', [chunk(1)]],
    ['without having begun', [end()]],
    ['ended after 11 of 12 bytes', [begin(), chunk(...positions.slice(1)), end()]],
    ['more than the 12 bytes', [begin(), chunk(...positions, 0)]],
    ['at most 16777216', [begin({ count: 2 ** 25 })]],
    ['the radius NaN', [begin({ radius: NaN })]],
    [
      'have 1174405120 bytes; at most 268435456',
      [begin({ count: 2 ** 24, arrays: [position, ['other', ElementType.FLOAT32, 16]] })],
    ],
    ['no finite box', [begin({ max: Infinity })]],
    ["the first array is ''; it must be 'position'", [begin({ arrays: [] })]],
    ["the first array is 'level'", [begin({ arrays: [level, position] })]],
    ["array 'position' comes twice", [begin({ arrays: [position, position] })]],
    ["'position' is FLOAT32 x 3; it must be UINT16 x 3", [begin({ arrays: [['position', ElementType.FLOAT32, 3]] })]],
    ['element type 9', [begin({ arrays: [position, ['id', 9 as ElementType, 1]] })]],
    ['17 components; it must have 1 to 16', [begin({ arrays: [position, ['id', ElementType.INT32, 17]] })]],
    [
      '19 arrays; at most 18',
      [begin({ arrays: [position, ...Array.from({ length: 18 }, (_, i): Listed => [`a${i}`, ElementType.INT32, 1])] })],
    ],
  ])('refuses: %s', (words, messages) => {
    expect(() => take(...messages)).toThrow(words);
  });
});

describe('KeptParticles', () => {
  const of = (index: number, runId = 7n): Particles => ({
    ...take(begin(), chunk(...positions), end())!,
    index: BigInt(index),
    runId,
  });
  const nearest = (kept: KeptParticles, index: number, runId = 7n): number =>
    Number(kept.nearest({ index: BigInt(index), runId })?.index ?? -1);

  it('finds those of the frame, or else the nearest of its run', () => {
    const kept = new KeptParticles({ frames: 10, bytes: 1000 });
    for (const index of [1, 2, 5]) kept.add(of(index));
    kept.add(of(3, 8n));
    expect([1, 2, 3, 4, 9].map((index) => nearest(kept, index))).toEqual([1, 2, 2, 5, 5]);
    expect(nearest(kept, 5, 8n)).toBe(3);
    expect(nearest(kept, 5, 9n)).toBe(-1);
    kept.clear();
    expect(nearest(kept, 5)).toBe(-1);
  });

  it('forgets the oldest past its limits', () => {
    const few = new KeptParticles({ frames: 2, bytes: 1000 });
    const small = new KeptParticles({ frames: 10, bytes: 30 });
    for (const index of [1, 2, 3]) for (const kept of [few, small]) kept.add(of(index));
    expect([nearest(few, 0), nearest(small, 0)]).toEqual([2, 2]);
  });
});

describe('ParticleWatch', () => {
  class FakeServer implements ParticleServer {
    readonly signals: AbortSignal[] = [];
    answers: WatchParticlesResponse[] = [];
    error: Error | undefined;
    async *watchParticles(
      request: { maxParticles: bigint },
      signal: AbortSignal,
    ): AsyncGenerator<Received<WatchParticlesResponse>, void> {
      expect(request.maxParticles).toBe(maxParticles);
      this.signals.push(signal);
      for (const message of this.answers) yield { message, bytes: 1 };
      if (this.error) throw this.error;
      await new Promise<void>((resolve) => {
        signal.addEventListener('abort', () => {
          resolve();
        });
      });
    }
  }
  let server: FakeServer;
  let received: bigint[];
  let reasons: string[];
  let watch: ParticleWatch;

  beforeEach(() => {
    vi.useFakeTimers();
    server = new FakeServer();
    received = [];
    reasons = [];
    watch = new ParticleWatch(server, 'an-id', {
      particles: ({ index }) => received.push(index),
      failed: (reason) => reasons.push(reason),
      received: () => undefined,
    });
  });
  afterEach(() => {
    watch.setWanted(false);
    vi.useRealTimers();
  });

  it('asks only while it is wanted', async () => {
    server.answers = [begin(), chunk(...positions), end()];
    await vi.advanceTimersByTimeAsync(60_000);
    expect(server.signals).toHaveLength(0);
    watch.setWanted(true);
    watch.setWanted(true);
    await vi.advanceTimersByTimeAsync(60_000);
    expect(received).toEqual([3n]);
    watch.setWanted(false);
    expect(server.signals.map(({ aborted }) => aborted)).toEqual([true]);
  });

  it('tries again, and reports errors that it alone meets', async () => {
    server.error = new RpcError(Code.resourceExhausted, '8 watchers');
    watch.setWanted(true);
    await vi.advanceTimersByTimeAsync(60_000);
    expect(server.signals.length).toBeGreaterThan(3);
    expect(reasons.at(-1)).toContain('8 watchers');
    const reported = reasons.length;
    server.error = new RpcError(Code.unavailable, 'gone');
    await vi.advanceTimersByTimeAsync(60_000);
    expect(reasons).toHaveLength(reported);
    watch.setWanted(false);
    const calls = server.signals.length;
    await vi.advanceTimersByTimeAsync(60_000);
    expect(server.signals).toHaveLength(calls);
  });
});
