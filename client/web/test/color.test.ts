import { readFileSync } from 'node:fs';
import { describe, expect, it } from 'vitest';
import type { VertexAttribute } from '../src/bricks/attributes';
import type { Shown } from '../src/bricks/brick_store';
import { colorMapNames, colorOf } from '../src/color/color_maps';
import { colorOfId } from '../src/color/id_palette';
import { Quantity } from '../src/color/quantity';
import { aroundZero, partOf, rangeText, ticks, unionOfRanges, valueText } from '../src/color/value_range';
import type { AttributeArray } from '../src/decode/attribute_values';
import type { DecodedBrick } from '../src/decode/decoded_brick';

describe('color maps', () => {
  it('have the table of the command line', () => {
    const read = (path: string): string => readFileSync(new URL(path, import.meta.url), 'utf8');
    /** Six digits each, and the names before them. */
    const table = (source: string, name: RegExp): string[] =>
      [...source.matchAll(new RegExp(`${name.source}|(?<![0-9a-z])([0-9a-f]{6})(?![0-9a-z])`, 'g'))].map(
        ([, map, color]) => map ?? color!,
      );
    const ours = table(read('../src/color/color_maps.ts'), /\n {2}(\w+):\n/);
    const theirs = table(read('../../picture/color_maps.cpp'), /case ColorMap::(\w+):/);
    expect(ours).toHaveLength(5 * 53);
    expect(theirs).toEqual(ours);
    expect(ours.filter((word) => !/^[0-9a-f]{6}$/.test(word))).toEqual(colorMapNames);
  });

  it('begin and end with their published colors, and take what lies outside as the nearer end', () => {
    expect([colorOf('viridis', 0), colorOf('viridis', 1), colorOf('viridis', 9)]).toEqual([
      [68, 1, 84],
      [253, 231, 37],
      [253, 231, 37],
    ]);
    expect([colorOf('coolwarm', 0), colorOf('coolwarm', 1), colorOf('magma', -1)]).toEqual([
      [59, 76, 192],
      [180, 4, 38],
      [0, 0, 4],
    ]);
  });

  it.each(['viridis', 'magma', 'plasma', 'cividis'] as const)('grow lighter all the way: %s', (map) => {
    const luminance = (i: number): number => {
      const [r, g, b] = colorOf(map, i / 51).map((x) => (x / 255) ** 2.2) as [number, number, number];
      return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    for (let i = 1; i <= 51; ++i) expect(luminance(i)).toBeGreaterThan(luminance(i - 1));
  });
});

describe('ids', () => {
  it('have the colors of the command line, those in a row far apart', () => {
    expect([0, 1, 2, -7].map(colorOfId)).toEqual([
      [177, 37, 37],
      [87, 125, 219],
      [150, 214, 61],
      [68, 61, 214],
    ]);
    expect(colorOfId(-7)).toEqual(colorOfId(2 ** 32 - 7));
  });
});

describe('ranges', () => {
  it('have round ticks within', () => {
    expect(ticks({ low: 0, high: 5 }, 6)).toEqual([0, 1, 2, 3, 4, 5]);
    expect(ticks({ low: 0, high: 5 }, 5)).toEqual([0, 2, 4]);
    expect(ticks({ low: -1.3, high: 1.1 }, 3)).toEqual([-1, 0, 1]);
    expect(ticks({ low: 3, high: 3 }, 6)).toEqual([3]);
    expect(ticks({ low: 1e6, high: 1e6 + 1 }, 3)).toEqual([1e6, 1e6 + 0.5, 1e6 + 1]);
  });

  it('are written with the digits that differ, and no more', () => {
    expect(valueText(0.1 + 0.2, 5)).toBe('0.3');
    expect(valueText(1e6 + 0.25, 1)).toBe('1000000.25');
    expect([valueText(-0, 1), valueText(1e-9, 1), valueText(0, 0)]).toEqual(['0', '0', '0']);
    expect(rangeText({ low: 0.123456, high: 4.87654 })).toBe('0.123 to 4.877');
    expect(rangeText({ low: 3, high: 3 })).toBe('3 to 3');
  });

  it('are joined, and put around zero', () => {
    expect(unionOfRanges([undefined, { low: 1, high: 2 }, { low: -1, high: 0 }])).toEqual({ low: -1, high: 2 });
    expect(unionOfRanges([undefined])).toBeUndefined();
    expect(aroundZero({ low: -1, high: 3 })).toEqual({ low: -3, high: 3 });
    expect(aroundZero({ low: 1, high: 3 })).toEqual({ low: 1, high: 3 });
    expect([partOf(2, { low: 1, high: 3 }), partOf(9, { low: 9, high: 9 })]).toEqual([0.5, 0.5]);
  });
});

function attribute(name: string, type: VertexAttribute['type'], components: number): VertexAttribute {
  return { name, type, components, minimum: [], maximum: [], carried: true };
}

function brick(name: string, components: number, values: AttributeArray): DecodedBrick {
  return {
    positions: new Uint16Array((4 * values.length) / components),
    attribute: { name, components, values },
  } as DecodedBrick;
}

function shown(attributes: VertexAttribute[], ...bricks: DecodedBrick[]): Shown {
  return {
    frame: { attributes } as unknown as Shown['frame'],
    bricks: new Map(bricks.map((decoded, i) => [String(i), { encoded: {} as never, decoded }])),
  };
}

describe('a quantity', () => {
  const velocity = attribute('velocity', 'float32', 3);
  const moving = brick('velocity', 3, Float32Array.of(3, 4, 0, 0, 0, 2, -1, 0, 0));

  it('of a vector is its magnitude, or one of its components', () => {
    const speed = new Quantity(velocity, {});
    expect([speed.kind, speed.title, [...speed.of(moving)!.values]]).toEqual([
      'number',
      'velocity, magnitude',
      [5, 2, 1],
    ]);
    const x = new Quantity(velocity, { component: 'x' });
    expect([x.title, [...x.of(moving)!.values]]).toEqual(['velocity.x', [3, 0, -1]]);
    expect(new Quantity(velocity, { component: 'w' }).title).toBe('velocity, magnitude');
  });

  it('has the range that the mesh announces for a component, and that of its vertices for a magnitude', () => {
    const announced = { ...velocity, minimum: [-9, 0, 0], maximum: [9, 5, 6] };
    const still = brick('velocity', 3, Float32Array.of(0, 0, 0.5));
    expect(new Quantity(announced, { component: 'x' }).rangeOf(shown([announced], moving))).toEqual({
      low: -9,
      high: 9,
    });
    expect(new Quantity(announced, {}).rangeOf(shown([announced], moving, still))).toEqual({ low: 0.5, high: 5 });
    expect(new Quantity(announced, {}).rangeOf(shown([announced]))).toBeUndefined();
  });

  it('is interpolated in a triangle; of an id it is that of the nearest vertex', () => {
    const weights = [0.5, 0.2, 0.3] as const;
    expect(new Quantity(velocity, {}).textAt(moving, [0, 1, 2], weights, 5)).toBe('3.2');
    const ids = brick('id', 1, Int32Array.of(-7, 2 ** 31 - 1, 5));
    const id = new Quantity(attribute('id', 'int32', 1), {});
    expect([id.kind, id.textAt(ids, [0, 1, 2], [0.3, 0.4, 0.3], 0)]).toEqual(['id', '2147483647']);
    expect([...id.of(ids)!.values.subarray(0, 3)]).toEqual(colorOfId(-7));
    expect(id.rangeOf(shown([], ids))).toBeUndefined();
  });

  it('of uint8 that is called a color is that color', () => {
    const bytes = brick('rgba', 4, Uint8Array.of(255, 0, 9, 1, 1, 2, 4, 1, 0, 0, 0, 0));
    const color = new Quantity(attribute('rgba', 'uint8', 4), {});
    expect([color.kind, [...color.of(bytes)!.values]]).toEqual(['color', [255, 0, 9, 0, 1, 2, 4, 0, 0, 0, 0, 0]]);
    expect(color.textAt(bytes, [0, 1, 2], [0.5, 0.5, 0], 0)).toBe('128, 1, 7');
    expect(new Quantity(attribute('phases', 'uint8', 3), {}).kind).toBe('number');
  });

  it('is nothing of a brick that was decoded without it', () => {
    const other = brick('age', 1, Float32Array.of(1));
    expect(new Quantity(velocity, {}).of(other)).toBeUndefined();
    expect(new Quantity(velocity, {}).of({ positions: new Uint16Array(4) } as DecodedBrick)).toBeUndefined();
  });
});
