import { describe, expect, it } from 'vitest';
import { knownCodecs } from '../src/bricks/codecs';
import type { Frame } from '../src/bricks/frame';
import { FrameReceiver } from '../src/bricks/frame_receiver';
import type { Codec } from '../src/gen/meniscus/v1/mesh_pb';
import type { WatchResponse } from '../src/gen/meniscus/v1/surface_service_pb';
import { begin, brick, frame, sprayPoints, statistics, type FrameOptions } from './support/messages';

function take(receiver: FrameReceiver, messages: WatchResponse[]): Frame | undefined {
  let complete: Frame | undefined;
  for (const message of messages) complete = receiver.take(message, 10, 5) ?? complete;
  return complete;
}

function taken(receiver: FrameReceiver, options: FrameOptions): Frame {
  return take(receiver, frame(options))!;
}

describe('FrameReceiver', () => {
  const two: FrameOptions = { index: 1, bricks: [{ place: [0, 0, 0] }, { place: [1, 0, 0], triangles: 2 }] };

  it('gives a frame when its statistics come, not before', () => {
    const receiver = new FrameReceiver();
    const messages = frame(two);
    expect(take(receiver, messages.slice(0, -1))).toBeUndefined();
    const complete = take(receiver, messages.slice(-1))!;
    expect([complete.index, complete.bricks.size, complete.triangleCount, complete.bytes]).toEqual([1n, 2, 3, 40]);
  });

  it('merges a difference with its base and keeps the bricks that stay', () => {
    const receiver = new FrameReceiver();
    const first = taken(receiver, two);
    const second = taken(receiver, {
      index: 2,
      base: 1,
      vanished: [[0, 0, 0]],
      bricks: [{ place: [2, 0, 0] }],
      triangles: 3,
    });
    expect([...second.bricks.keys()]).toEqual(['1,0,0', '2,0,0']);
    expect(second.bricks.get('1,0,0')).toBe(first.bricks.get('1,0,0'));
    expect([...first.bricks.keys()]).toEqual(['0,0,0', '1,0,0']);
  });

  it('forgets a frame that is abandoned, as if none of it had come', () => {
    const receiver = new FrameReceiver();
    const first = taken(receiver, two);
    take(receiver, frame({ index: 2, base: 1, vanished: [[1, 0, 0]], bricks: [{ place: [5, 5, 5] }] }).slice(0, 2));
    const third = taken(receiver, { index: 3, base: 1, triangles: 3 });
    expect([...third.bricks.values()]).toEqual([...first.bricks.values()]);
  });

  it('abandons in the middle of a brick as well', () => {
    const receiver = new FrameReceiver();
    take(receiver, [begin(two), brick([0, 0, 0], 1, [1], 0, 2)]);
    expect(taken(receiver, two).index).toBe(1n);
  });

  it('joins the parts of a brick', () => {
    const complete = taken(new FrameReceiver(), {
      index: 1,
      bricks: [{ place: [0, 0, 0], parts: [[1, 2], [3], [4]] }],
    });
    expect([...complete.bricks.get('0,0,0')!.data]).toEqual([1, 2, 3, 4]);
  });

  it('joins the messages of the spray, which each frame has anew', () => {
    const receiver = new FrameReceiver();
    const spray = [
      [1, 2, 3, 4.5, 5, 6],
      [-7, 8, 9],
    ];
    expect([...taken(receiver, { ...two, spray }).spray]).toEqual([1, 2, 3, 4.5, 5, 6, -7, 8, 9]);
    expect(taken(receiver, { index: 2, base: 1, triangles: 3 }).spray.length).toBe(0);
  });

  const refusals: [string, WatchResponse[]][] = [
    ['outside of a frame', [brick([0, 0, 0])]],
    ['without its mesh', [statistics(1)]],
    ['without its mesh', [begin({ index: 1 }), statistics(2)]],
    ['ended after 0 of 1 bricks', [begin({ index: 1, bricks: [{ place: [0, 0, 0] }] }), statistics(1)]],
    ['one more than the 0', [begin({ index: 1 }), brick([0, 0, 0])]],
    ['came twice', [begin(two), brick([0, 0, 0]), brick([0, 0, 0])]],
    ['begins with part 1', [begin(two), brick([0, 0, 0], 1, [1], 1, 2)]],
    ['in place of part 1', [begin(two), brick([0, 0, 0], 1, [1], 0, 2), brick([1, 0, 0], 1, [1], 1, 2)]],
    [
      `has the codec 7, which this viewer does not know; it knows ${knownCodecs.join(', ')}`,
      [begin(two), brick([0, 0, 0], 1, [1], 0, 1, 7 as Codec)],
    ],
    ['has the codec 0', [begin(two), brick([0, 0, 0], 1, [1], 0, 1, 0)]],
    ['in place of part 1', [begin(two), brick([0, 0, 0], 1, [1], 0, 2), brick([0, 0, 0], 1, [1], 1, 2, 7 as Codec)]],
    ['announced were 9', frame({ ...two, triangles: 9 })],
    ['outside of a frame', [sprayPoints([1, 2, 3])]],
    ['no whole points', [begin({ index: 1, sprayCount: 1 }), sprayPoints([1, 2])]],
    ['no whole points', [begin({ index: 1, sprayCount: 1 }), sprayPoints([])]],
    ['more than the 1 points', frame({ index: 1, spray: [[1, 2, 3, 4, 5, 6]], sprayCount: 1 })],
    ['after 1 of 2 points of spray', frame({ index: 1, spray: [[1, 2, 3]], sprayCount: 2 })],
    ['difference to frame 4', frame({ index: 5, base: 4 })],
    ['vanished without having been', [...frame(two), begin({ index: 2, base: 1, vanished: [[9, 9, 9]] })]],
    ['but no base', [begin({ index: 2, vanished: [[9, 9, 9]] })]],
  ];
  it.each(refusals)('refuses: %s', (words, messages) => {
    expect(() => take(new FrameReceiver(), messages)).toThrow(words);
  });

  it('refuses a lattice that it does not know', () => {
    const changed = (
      change: (value: { offsetBits: number; brickCells: number; cellSize: number }) => void,
    ): WatchResponse => {
      const message = begin({ index: 1 });
      if (message.message.case === 'meshBegin') change(message.message.value);
      return message;
    };
    expect(() => take(new FrameReceiver(), [changed((b) => (b.offsetBits = 9))])).toThrow(
      'offset_bits 9; allowed are 2 to 8',
    );
    expect(() => take(new FrameReceiver(), [changed((b) => (b.brickCells = 32))])).toThrow('bricks of 32 cells');
    expect(() => take(new FrameReceiver(), [changed((b) => (b.cellSize = NaN))])).toThrow('cell_size NaN');
  });

  it('merges random differences to the same bricks as whole frames', () => {
    let seed = 1;
    const random = (below: number): number => (seed = (seed * 48271) % 2147483647) % below;
    const receiver = new FrameReceiver();
    let mesh = new Map<string, number>();
    for (let index = 1; index <= 200; ++index) {
      const next = new Map<string, number>();
      for (let x = 0; x < 6; ++x)
        if (random(4) > 0) next.set(`${x},0,0`, random(2) === 0 ? index : (mesh.get(`${x},0,0`) ?? index));
      const place = (key: string): [number, number, number] => key.split(',').map(Number) as [number, number, number];
      const changed = [...next].filter(([key, version]) => mesh.get(key) !== version);
      const vanished = [...mesh.keys()].filter((key) => !next.has(key)).map(place);
      const received = taken(receiver, {
        index,
        ...(index === 1 ? {} : { base: index - 1, vanished }),
        bricks: changed.map(([key, version]) => ({ place: place(key), parts: [[version & 0xff]] })),
        triangles: next.size,
      });
      mesh = next;
      const bricks = new Map([...received.bricks].map(([key, { data }]) => [key, data[0]]));
      expect(bricks).toEqual(new Map([...next].map(([key, version]) => [key, version & 0xff])));
    }
  });
});
