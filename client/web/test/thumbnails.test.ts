import { beforeEach, describe, expect, it, vi } from 'vitest';
import { Thumbnails, thumbnailEvery, thumbnailPatience } from '../src/list/thumbnails';
import { Code, RpcError } from '../src/rpc/status';

describe('thumbnails', () => {
  let now: number;
  let asked: string[];
  let under: { signal: AbortSignal; end: (error?: Error) => Promise<void> }[];
  let thumbnails: Thumbnails;
  const sessions = (...frames: number[]) => frames.map((n, i) => ({ id: 'abcdef'[i]!, frames: BigInt(n) }));

  beforeEach(() => {
    now = 0;
    asked = [];
    under = [];
    thumbnails = new Thumbnails(
      (session, signal) => {
        asked.push(session);
        return new Promise((resolve, reject) => {
          const end = async (error?: Error): Promise<void> => {
            if (error) reject(error);
            else resolve();
            // What follows it follows at once.
            for (let turn = 0; turn < 5; ++turn) await Promise.resolve();
          };
          under.push({ signal, end });
        });
      },
      () => now,
    );
  });
  const see = (...ids: string[]): void => {
    for (const id of ids) thumbnails.setVisible(id, true);
  };

  it('are asked for one after the other, of what is on the screen alone', async () => {
    thumbnails.update(sessions(1, 1, 1));
    expect(asked).toEqual([]);
    see('a', 'c');
    expect(asked).toEqual(['a']);
    await under[0]!.end();
    expect(asked).toEqual(['a', 'c']);
    await under[1]!.end();
    expect(asked).toEqual(['a', 'c']);
  });

  it('are asked for again where one has not come, also of a session that rests', async () => {
    thumbnails.update(sessions(1));
    see('a');
    await under[0]!.end(new RpcError(Code.unavailable, 'busy'));
    thumbnails.update(sessions(1));
    expect(asked).toEqual(['a']);
    now = thumbnailEvery;
    thumbnails.update(sessions(1));
    expect(asked).toEqual(['a', 'a']);
  });

  it('are asked for of what was on the screen before its list came: of a tab that was opened behind others', () => {
    see('b');
    thumbnails.update(sessions(1, 1));
    expect(asked).toEqual(['b']);
  });

  it('are asked for again after ten seconds at the earliest, and only where there is a newer frame', async () => {
    thumbnails.update(sessions(1, 1));
    see('a', 'b');
    await under[0]!.end();
    await under[1]!.end();
    now = thumbnailEvery - 1;
    thumbnails.update(sessions(2, 1));
    expect(asked).toEqual(['a', 'b']);
    now = thumbnailEvery;
    thumbnails.update(sessions(2, 1));
    expect(asked).toEqual(['a', 'b', 'a']);
  });

  it('give none its second before each has its first', async () => {
    thumbnails.update(sessions(1, 1, 1));
    see('a', 'b', 'c');
    await under[0]!.end();
    now = 5 * thumbnailEvery;
    thumbnails.update(sessions(2, 2, 2));
    await under[1]!.end();
    await under[2]!.end();
    expect(asked).toEqual(['a', 'b', 'c', 'a']);
  });

  it('are not asked for of a session without frames, nor of one that has left the screen or the list', () => {
    thumbnails.update(sessions(0, 1, 1));
    see('a');
    thumbnails.setVisible('b', false);
    expect(asked).toEqual([]);
    thumbnails.update(sessions(0));
    see('b', 'c');
    expect(asked).toEqual([]);
  });

  it('end with the list, and begin again with it', async () => {
    thumbnails.update(sessions(1, 1));
    see('a', 'b');
    thumbnails.stop();
    expect(under[0]!.signal.aborted).toBe(true);
    await under[0]!.end(new RpcError(Code.canceled, 'canceled'));
    // Cards leave the screen one by one.
    thumbnails.setVisible('a', false);
    thumbnails.drawAnew();
    expect(asked).toEqual(['a']);
    see('a');
    thumbnails.update(sessions(1, 1));
    expect(asked).toEqual(['a', 'a']);
  });

  it('are not held up by one of which nothing is heard', async () => {
    vi.useFakeTimers();
    try {
      thumbnails.update(sessions(1, 1));
      see('a', 'b');
      vi.advanceTimersByTime(thumbnailPatience - 1);
      expect(under[0]!.signal.aborted).toBe(false);
      vi.advanceTimersByTime(1);
      expect(under[0]!.signal.aborted).toBe(true);
      await under[0]!.end(new RpcError(Code.canceled, 'canceled'));
      expect(asked).toEqual(['a', 'b']);
      await under[1]!.end();
      expect(vi.getTimerCount()).toBe(0);
    } finally {
      vi.useRealTimers();
    }
  });

  it('go on after one that failed, and stop where the server makes none', async () => {
    thumbnails.update(sessions(1, 1, 1));
    see('a', 'b', 'c');
    await under[0]!.end(new RpcError(Code.resourceExhausted, 'too many'));
    await under[1]!.end(new RpcError(Code.unimplemented, 'no such call'));
    now = thumbnailEvery;
    thumbnails.update(sessions(2, 2, 2));
    expect(asked).toEqual(['a', 'b']);
  });

  it('are drawn anew in other colors, though nothing else is new', async () => {
    thumbnails.update(sessions(1));
    see('a');
    await under[0]!.end();
    thumbnails.drawAnew();
    expect(asked).toEqual(['a', 'a']);
  });
});
