import { describe, expect, it } from 'vitest';
import type { Frame } from '../src/bricks/frame';
import { Backoff } from '../src/stream/backoff';
import { LinkSpeed } from '../src/stream/link_speed';
import { chooseQuality, wishesOf } from '../src/stream/quality';

describe('quality', () => {
  it('is full at rest as long as a mesh comes within half a second', () => {
    expect(chooseQuality(false, 0)).toBe('full');
    expect(chooseQuality(false, 0.5)).toBe('full');
    expect(chooseQuality(false, 0.6)).toBe('light');
  });

  it('gives up bits while the camera moves, and levels where the link is slow', () => {
    expect(chooseQuality(true, 0)).toBe('light');
    expect(chooseQuality(true, 0.2)).toBe('coarse');
  });

  it('never asks for more bits than the mesh has', () => {
    expect(wishesOf('light', 2).positionBits).toBe(2);
    expect(wishesOf('coarse', 8)).toMatchObject({ positionBits: 3, maxLevel: 2 });
    expect(wishesOf('full', 8)).toEqual({});
  });
});

describe('LinkSpeed', () => {
  const frame = (bytes: number, ms: number, meshBytes: number): Frame =>
    ({ bytes, beganAt: 100, arrivedAt: 100 + ms, offsetBits: 6, bricks: new Map([['0', { draco: { length: meshBytes } }]]) }) as unknown as Frame;

  it('tells how long the whole mesh would take, from differences as well', () => {
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

describe('Backoff', () => {
  it('doubles up to its longest wait, by a random part of it', () => {
    const backoff = new Backoff({ first: 100, longest: 300 }, () => 1);
    expect([backoff.next(), backoff.next(), backoff.next(), backoff.next()]).toEqual([100, 200, 300, 300]);
    backoff.reset();
    expect(backoff.next()).toBe(100);
    expect(new Backoff({ first: 100, longest: 300 }, () => 0).next()).toBe(50);
  });
});
