import { describe, expect, it } from 'vitest';
import type { Frame } from '../src/bricks/frame';
import { Backoff } from '../src/stream/backoff';
import { LinkSpeed } from '../src/stream/link_speed';
import { chooseQuality, watchOptions } from '../src/stream/quality';
import { SkippedFrames } from '../src/stream/skipped_frames';

describe('quality', () => {
  it('is full at rest as long as a mesh comes within half a second', () => {
    expect(chooseQuality(false, 0, 'full')).toBe('full');
    expect(chooseQuality(false, 0.5, 'full')).toBe('full');
    expect(chooseQuality(false, 0.6, 'full')).toBe('light');
  });

  it('gives up bits while the camera moves, and levels where the link is slow', () => {
    expect(chooseQuality(true, 0, 'full')).toBe('light');
    expect(chooseQuality(true, 0.2, 'full')).toBe('coarse');
  });

  it('does not swing to and fro with a link at its limits', () => {
    const swings = (moving: boolean, seconds: number[]): number => {
      let [quality, changes] = [chooseQuality(moving, 10, 'full'), 0];
      for (const s of seconds) {
        const next = chooseQuality(moving, s, quality);
        if (next !== quality) ++changes;
        quality = next;
      }
      return changes;
    };
    expect(swings(false, [0.55, 0.45, 0.55, 0.45])).toBe(0);
    expect(swings(true, [0.11, 0.09, 0.11, 0.09])).toBe(0);
    expect(swings(false, [0.3, 0.45, 0.3])).toBe(1);
  });

  it('never asks for more bits than the mesh has', () => {
    expect(watchOptions('light', 2).positionBits).toBe(2);
    expect(watchOptions('coarse', 8)).toMatchObject({ positionBits: 3, maxLevel: 2 });
    expect(watchOptions('full', 8)).toEqual({});
  });
});

describe('LinkSpeed', () => {
  const frame = (bytes: number, ms: number, meshBytes: number): Frame =>
    ({
      bytes,
      beganAt: 100,
      arrivedAt: 100 + ms,
      offsetBits: 6,
      bricks: new Map([['0', { data: { length: meshBytes } }]]),
    }) as unknown as Frame;

  it('estimates the time of the whole mesh, from differences as well', () => {
    const link = new LinkSpeed();
    link.add(frame(100_000, 50, 1_000_000), true);
    expect(link.secondsPerFullMesh).toBeCloseTo(0.5);
    expect(link.offsetBits).toBe(6);
  });

  it('draws no conclusion from a small frame, nor from lower quality about the size of the full mesh', () => {
    const link = new LinkSpeed();
    link.add(frame(100, 50, 100), true);
    expect(link.secondsPerFullMesh).toBe(0);
    link.add(frame(100_000, 100, 1_000_000), true);
    link.add(frame(100_000, 100, 10_000), false);
    expect(link.secondsPerFullMesh).toBeCloseTo(1);
  });
});

describe('SkippedFrames', () => {
  const at = (index: number, runId = 1n): Pick<Frame, 'runId' | 'index'> => ({ index: BigInt(index), runId });

  it('counts the frames between those that were shown, run by run, without what a pause left out', () => {
    const skipped = new SkippedFrames();
    for (const index of [3, 4, 7, 7]) skipped.shown(at(index));
    expect(skipped.count).toBe(2);
    skipped.shown(at(100, 2n));
    skipped.pause();
    skipped.shown(at(200, 2n));
    expect(skipped.count).toBe(2);
    skipped.shown(at(202, 2n));
    expect(skipped.count).toBe(3);
  });
});

describe('Backoff', () => {
  it('doubles up to its longest wait, by a random part of it', () => {
    const backoff = new Backoff({ first: 100, longest: 300 }, () => 1);
    expect([backoff.next(), backoff.next(), backoff.next(), backoff.next()]).toEqual([100, 200, 300, 300]);
    backoff.reset();
    expect(backoff.next()).toBe(100);
    expect(new Backoff({ first: 100, longest: 300 }, () => 0).next()).toBe(50);
  });
});
