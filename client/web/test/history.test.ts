import { describe, expect, it } from 'vitest';
import type { EncodedBrick, Frame } from '../src/bricks/frame';
import { Codec } from '../src/gen/meniscus/v1/mesh_pb';
import { History } from '../src/bricks/history';

function brick(bytes: number): EncodedBrick {
  return {
    place: [0, 0, 0],
    vertexCount: 0,
    triangleCount: 0,
    cellLevels: new Uint8Array(0),
    codec: Codec.DRACO,
    data: new Uint8Array(bytes),
    attributes: [],
  };
}

function frame(index: number, ...bricks: EncodedBrick[]): Frame {
  return {
    index: BigInt(index),
    runId: 1n,
    bricks: new Map(bricks.map((b, i) => [String(i), b])),
    spray: new Float32Array(0),
  } as unknown as Frame;
}

describe('History', () => {
  it('keeps the newest frames up to its number', () => {
    const history = new History({ frames: 3, bytes: 1000 });
    for (let index = 0; index < 5; ++index) history.add(frame(index, brick(1)));
    expect(history.frames.map((f) => f.index)).toEqual([2n, 3n, 4n]);
    expect(history.bytes).toBe(3);
  });

  it('counts a shared brick once and lets it go with the last frame that has it', () => {
    const history = new History({ frames: 100, bytes: 250 });
    const shared = brick(100);
    history.add(frame(1, shared));
    history.add(frame(2, shared, brick(100)));
    expect(history.bytes).toBe(200);
    history.add(frame(3, brick(60)));
    expect(history.frames.map((f) => f.index)).toEqual([2n, 3n].slice(1));
    expect(history.bytes).toBe(60);
  });

  it('counts the spray of each frame', () => {
    const history = new History({ frames: 2, bytes: 1000 });
    for (let index = 0; index < 3; ++index) history.add({ ...frame(index, brick(1)), spray: new Float32Array(3) });
    expect(history.bytes).toBe(2 * 13);
  });

  it('never drops the newest, however large', () => {
    const history = new History({ frames: 3, bytes: 10 });
    history.add(frame(1, brick(50)));
    expect(history.frames).toHaveLength(1);
  });

  it('has one entry for a moment that came again at another quality', () => {
    const history = new History({ frames: 3, bytes: 1000 });
    history.add(frame(1, brick(5)));
    history.add(frame(1, brick(9)));
    expect([history.frames.length, history.bytes]).toEqual([1, 9]);
  });
});
