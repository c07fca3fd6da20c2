// Bricks of the lattice codec that are damaged, or that lie. golden_bricks.test.ts has those that are whole.
import { describe, expect, it } from 'vitest';
import { decodeBrick } from '../src/decode/decode_brick';
import type { EncodedBrick } from '../src/bricks/frame';
import { maxBrickTriangles } from '../src/bricks/lattice';
import { Codec } from '../src/gen/meniscus/v1/mesh_pb';
import { dracoDecoder } from './support/draco';
import { encoded, golden } from './support/golden';
import { latticeDecoder } from './support/lattice';

const lattice = await latticeDecoder();
const decoders = { draco: await dracoDecoder(), lattice };
const bricks = golden.bricks
  .filter(({ codec }) => codec !== Codec.DRACO)
  .map((brick) => [brick.name, encoded(brick), brick.offset_bits] as const);

/** Whether it was refused, in words that name it. A decoder that broke would say so in others. */
function isRefused(brick: EncodedBrick, offsetBits: number): boolean {
  try {
    decodeBrick(decoders, brick, offsetBits);
    return false;
  } catch (error) {
    expect(String(error)).toMatch(/^Error: brick \(0, 0, 0\): (its|has|ends|goes on|announces) /);
    return true;
  }
}

describe.skipIf(!lattice)('bricks of the lattice codec', () => {
  it.each(bricks)('are refused where they are cut: %s', (_, brick, offsetBits) => {
    const whole = decodeBrick(decoders, brick, offsetBits);
    for (let length = 0; length < brick.data.length; ++length)
      expect(isRefused({ ...brick, data: brick.data.slice(0, length) }, offsetBits)).toBe(true);
    expect(decodeBrick(decoders, brick, offsetBits)).toEqual(whole);
  });

  it.each(bricks)('are refused or decoded with any bit flipped: %s', (_, brick, offsetBits) => {
    const whole = decodeBrick(decoders, brick, offsetBits);
    let refused = 0;
    for (let bit = 0; bit < 8 * brick.data.length; ++bit) {
      const data = brick.data.slice();
      data[bit >> 3]! ^= 1 << (bit & 7);
      if (isRefused({ ...brick, data }, offsetBits)) ++refused;
    }
    expect(refused).toBeGreaterThan(0);
    expect(decodeBrick(decoders, brick, offsetBits)).toEqual(whole);
  });

  it.each([
    ['has another number of triangles', { triangleCount: 279 }],
    ['vertices', { vertexCount: 141 }],
    ['announces more', { triangleCount: maxBrickTriangles }],
    ['a brick has at most', { triangleCount: 2 ** 31 }],
    ['a brick has at most', { vertexCount: 2 ** 32 - 1 }],
    ['first bytes', { data: new Uint8Array(100) }],
    ['first bytes', { data: new Uint8Array() }],
  ])('are refused where they lie: %s', (words, lie) => {
    for (const [, brick, offsetBits] of bricks.filter(([name]) =>
      name.endsWith('levels and cracks, normals of 8 bits'),
    )) {
      expect(() => decodeBrick(decoders, { ...brick, ...lie, place: [4, 5, 6] }, offsetBits)).toThrow(words);
      expect(() => decodeBrick(decoders, { ...brick, ...lie, place: [4, 5, 6] }, offsetBits)).toThrow(
        'brick (4, 5, 6)',
      );
      expect(() => decodeBrick(decoders, brick, offsetBits + 1)).toThrow('other offset bits');
    }
  });

  it('are not known without their decoder', () => {
    for (const [, brick, offsetBits] of bricks)
      expect(() => decodeBrick({ draco: decoders.draco }, brick, offsetBits)).toThrow(
        `brick (0, 0, 0): this viewer does not know its codec, ${brick.codec}`,
      );
  });
});
