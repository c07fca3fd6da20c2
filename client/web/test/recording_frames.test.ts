import { describe, expect, it, vi } from 'vitest';
import { recordedFrames } from '../src/recordings/recorded_frames';
import { RecordingFrames, type RecordingFramesLimits } from '../src/recordings/recording_frames';
import { frame } from './support/messages';

interface Call {
  readonly position: number;
  readonly count: number;
  readonly signal: AbortSignal;
  /** Sends `count` of its frames. */
  send(count: number): Promise<void>;
  fail(error: Error): Promise<void>;
}

/** A recording whose frames have the tenfold of their places as indices, and a brick of `brickBytes` each. */
function recording(length: number, limits: Partial<RecordingFramesLimits> = {}, brickBytes = 10) {
  const calls: Call[] = [];
  const shown: number[] = [];
  const failed: unknown[] = [];
  const settle = () =>
    vi
      .waitFor(() => undefined)
      .then(
        () =>
          new Promise<void>((resolve) => {
            setTimeout(resolve);
          }),
      );
  const frames = new RecordingFrames(
    length,
    async function* (position, count, signal) {
      let allowed = 0;
      let failure: Error | undefined;
      let wake = () => undefined as unknown;
      calls.push({
        position,
        count,
        signal,
        send: (more) => {
          allowed += more;
          wake();
          return settle();
        },
        fail: (error) => {
          failure = error;
          wake();
          return settle();
        },
      });
      for (let i = 0; i < count; ++i) {
        while (allowed <= i) {
          if (failure) throw failure;
          if (signal.aborted) return;
          await new Promise<void>((resolve) => {
            wake = () => {
              resolve();
              return undefined;
            };
            signal.addEventListener('abort', () => {
              resolve();
            });
          });
        }
        const bricks = [
          { place: [0, 0, 0] as [number, number, number], parts: [new Array<number>(brickBytes).fill(0)] },
        ];
        yield* recordedFrames(
          (async function* () {
            for (const message of frame({ index: 10 * (position + i), bricks }))
              yield await Promise.resolve({ message, bytes: 7 });
          })(),
        );
      }
    },
    { ahead: 4, frames: 8, bytes: 1000, ...limits },
    {
      frame: ({ index }, position) => {
        expect(index).toBe(BigInt(10 * position));
        shown.push(position);
      },
      failed: (error) => {
        failed.push(error);
      },
      received: () => undefined,
    },
  );
  return { frames, calls, shown, failed };
}

describe('RecordingFrames', () => {
  it('fetches from the frame that is wanted on, and shows those that follow without asking again', async () => {
    const { frames, calls, shown } = recording(20);
    frames.show(6);
    expect([calls[0]!.position, calls[0]!.count]).toEqual([6, 4]);
    await calls[0]!.send(4);
    frames.show(7);
    expect(shown).toEqual([6, 7]);
    expect(calls).toHaveLength(1);
  });

  it('fetches the next part before it is needed, to the end and no further', async () => {
    const { frames, calls } = recording(10);
    frames.show(4);
    await calls[0]!.send(4);
    frames.show(7);
    expect([calls[1]!.position, calls[1]!.count]).toEqual([8, 2]);
  });

  it('gives up what it fetches for the latest frame that is wanted', async () => {
    const { frames, calls, shown } = recording(100);
    frames.show(10);
    frames.show(50);
    expect(calls[0]!.signal.aborted).toBe(true);
    await calls[0]!.send(4);
    await calls[1]!.send(1);
    expect(shown).toEqual([50]);
  });

  it('waits for a frame that is on its way', async () => {
    const { frames, calls, shown } = recording(100);
    frames.show(10);
    frames.show(12);
    expect(calls).toHaveLength(1);
    await calls[0]!.send(3);
    expect(shown).toEqual([12]);
  });

  it('keeps those used last, up to its number', async () => {
    const { frames, calls } = recording(100);
    for (const first of [0, 20, 40]) {
      frames.show(first);
      await calls.at(-1)!.send(4);
    }
    expect([0, 3, 20, 23, 40, 43].map((at) => frames.at(at) !== undefined)).toEqual([
      false,
      false,
      true,
      true,
      true,
      true,
    ]);
  });

  it('fetches no further where what comes first leaves no room, and always keeps the frame that is shown', async () => {
    const { frames, calls, shown } = recording(100, { bytes: 250 }, 100);
    frames.show(0);
    await calls[0]!.send(4);
    expect([0, 1, 2].map((at) => frames.at(at) !== undefined)).toEqual([true, true, false]);
    expect(calls[0]!.signal.aborted).toBe(true);
    expect(calls).toHaveLength(1);
    frames.show(1);
    await calls[1]!.send(1);
    frames.show(2);
    expect(shown).toEqual([0, 1, 2]);
    const large = recording(3, { bytes: 10 }, 100);
    large.frames.show(0);
    await large.calls[0]!.send(1);
    expect(large.shown).toEqual([0]);
  });

  it('reports a failure only where a frame is waited for, and tries again when it is wanted', async () => {
    const { frames, calls, shown, failed } = recording(100);
    frames.show(0);
    await calls[0]!.send(1);
    await calls[0]!.fail(new Error('gone'));
    expect(failed).toEqual([]);
    frames.show(3);
    await calls[1]!.fail(new Error('still gone'));
    expect(failed).toHaveLength(1);
    frames.show(3);
    await calls[2]!.send(1);
    expect(shown).toEqual([0, 3]);
  });

  it('reports nothing once it is stopped', async () => {
    const { frames, calls, shown } = recording(100);
    frames.show(0);
    frames.stop();
    await calls[0]!.send(4);
    expect(shown).toEqual([]);
  });
});
