import { describe, expect, it } from 'vitest';
import { writeWebm, type EncodedPicture } from '../src/save/webm';

interface Element {
  readonly id: number;
  /** The place of its first byte in the file, and of its content's. */
  readonly begins: number;
  readonly content: Uint8Array;
  readonly contentBegins: number;
}

/** The elements that follow each other there, which fill the bytes exactly. */
function parse(bytes: Uint8Array, from = 0): Element[] {
  const found: Element[] = [];
  for (let at = 0; at < bytes.length;) {
    const begins = from + at;
    const number = (mask: boolean): number => {
      const length = Math.clz32(bytes[at]!) - 23;
      let value = mask ? bytes[at]! & (0xff >> length) : bytes[at]!;
      for (let i = 1; i < length; ++i) value = value * 256 + bytes[at + i]!;
      at += length;
      return value;
    };
    const id = number(false);
    const size = number(true);
    if (at + size > bytes.length) throw new Error(`element ${id.toString(16)} is cut off`);
    found.push({ id, begins, content: bytes.subarray(at, at + size), contentBegins: from + at });
    at += size;
  }
  return found;
}

const inside = ({ content, contentBegins }: Element): Element[] => parse(content, contentBegins);
const only = (elements: Element[], id: number): Element => {
  const found = elements.filter((element) => element.id === id);
  expect(found).toHaveLength(1);
  return found[0]!;
};
const uintOf = ({ content }: Element): number => content.reduce((sum, byte) => sum * 256 + byte, 0);

/** Pictures of one byte each, their number; each k-th is a key picture. */
function pictures(count: number, every: number): EncodedPicture[] {
  return Array.from({ length: count }, (_, i) => ({ data: new Uint8Array([i]), key: i % every === 0 }));
}

function blocksOf(file: Uint8Array): { time: number; key: boolean; data: number[] }[] {
  const segment = only(parse(file), 0x18538067);
  return inside(segment)
    .filter(({ id }) => id === 0x1f43b675)
    .flatMap((cluster) => {
      const parts = inside(cluster);
      const time = uintOf(only(parts, 0xe7));
      return parts
        .filter(({ id }) => id === 0xa3)
        .map(({ content }) => ({
          time: time + content[1]! * 256 + content[2]!,
          key: content[3] === 0x80,
          data: [...content.subarray(4)],
        }));
    });
}

describe('a WebM file', () => {
  const options = { width: 640, height: 360, codec: 'V_VP9' as const };

  it.each([25, 24, 29.97, 120])('has every picture once, in order, at its time: %d a second', (rate) => {
    const file = writeWebm({ ...options, rate, pictures: pictures(200, 50) });
    expect(blocksOf(file)).toEqual(
      pictures(200, 50).map(({ key }, i) => ({ time: Math.round((1000 * i) / rate), key, data: [i] })),
    );
  });

  it('has size, codec and duration', () => {
    const segment = inside(only(parse(writeWebm({ ...options, rate: 25, pictures: pictures(100, 50) })), 0x18538067));
    const duration = only(inside(only(segment, 0x1549a966)), 0x4489).content;
    expect(new DataView(duration.buffer, duration.byteOffset).getFloat64(0)).toBe(4000);
    const track = inside(only(inside(only(segment, 0x1654ae6b)), 0xae));
    expect(new TextDecoder().decode(only(track, 0x86).content)).toBe('V_VP9');
    const video = inside(only(track, 0xe0));
    expect([uintOf(only(video, 0xb0)), uintOf(only(video, 0xba))]).toEqual([640, 360]);
  });

  it('leads from its list of places to each cluster, which begins with a key picture', () => {
    const file = writeWebm({ ...options, rate: 25, pictures: pictures(120, 50) });
    const segment = only(parse(file), 0x18538067);
    const clusters = inside(segment).filter(({ id }) => id === 0x1f43b675);
    const cues = inside(only(inside(segment), 0x1c53bb6b)).map((cue) => {
      const parts = inside(cue);
      return [uintOf(only(parts, 0xb3)), uintOf(only(inside(only(parts, 0xb7)), 0xf1))];
    });
    expect(clusters).toHaveLength(3);
    expect(cues).toEqual(clusters.map(({ begins }, i) => [2000 * i, begins - segment.contentBegins]));
  });

  it('refuses pictures whose time the format cannot hold', () => {
    expect(() => writeWebm({ ...options, rate: 1, pictures: pictures(40, 40) })).toThrow(
      'picture 31 comes more than 30000 ms after the last key picture',
    );
  });
});
