import { describe, expect, it } from 'vitest';
import { MessageParser } from '../src/rpc/message_parser';

function wire(flags: number, data: number[]): number[] {
  return [flags, 0, 0, data.length >> 8, data.length & 0xff, ...data];
}

describe('MessageParser', () => {
  const body = [...wire(0, [1, 2, 3]), ...wire(0, []), ...wire(0x80, [9])];

  it('gives the same messages wherever the body is cut', () => {
    for (let cut = 0; cut <= body.length; ++cut) {
      const parser = new MessageParser(10);
      const messages = [
        ...parser.push(Uint8Array.from(body.slice(0, cut))),
        ...parser.push(Uint8Array.from(body.slice(cut))),
      ];
      expect(messages.map(({ trailers, data }) => [trailers, [...data]])).toEqual([
        [false, [1, 2, 3]],
        [false, []],
        [true, [9]],
      ]);
      expect(parser.atBoundary).toBe(true);
    }
  });

  it('takes a message exactly as long as the limit and refuses a longer one before its bytes come', () => {
    expect(new MessageParser(3).push(Uint8Array.from(wire(0, [1, 2, 3])))).toHaveLength(1);
    expect(() => new MessageParser(3).push(Uint8Array.from([0, 0, 0, 0, 4]))).toThrow('4 bytes; the limit is 3');
  });

  it('refuses compressed messages', () => {
    expect(() => new MessageParser(3).push(Uint8Array.from(wire(1, [1])))).toThrow('flags 1');
  });

  it('knows that a body ended within a message', () => {
    const parser = new MessageParser(10);
    parser.push(Uint8Array.from(body.slice(0, 6)));
    expect(parser.atBoundary).toBe(false);
  });
});
