import { beforeAll, describe, expect, it } from 'vitest';
import type { DracoModule } from 'draco3d/draco_decoder_nodejs.js';
import { readAttributes, type CodedAttribute } from '../src/bricks/attributes';
import { BrickStore, type Shown } from '../src/bricks/brick_store';
import type { EncodedBrick, Frame } from '../src/bricks/frame';
import { FrameReceiver } from '../src/bricks/frame_receiver';
import { decodeBrick } from '../src/decode/decode_brick';
import { pointCount, type DecodedBrick } from '../src/decode/decoded_brick';
import { AttributeType, MeshAttributeSchema } from '../src/gen/meniscus/v1/mesh_pb';
import { create, type MessageInitShape } from '@bufbuild/protobuf';
import { watchOptions } from '../src/stream/quality';
import { dracoDecoder, encodeBrick, flat, type BrickOptions } from './support/draco';
import { frame } from './support/messages';

type Announced = MessageInitShape<typeof MeshAttributeSchema>;

const offsetBits = 6;
const placed: BrickOptions = { ...flat, place: [4, 5, 6] };
let draco: DracoModule;

beforeAll(async () => {
  draco = await dracoDecoder();
});

function form(name: string, type: CodedAttribute['type'], components: number, bits = 0): CodedAttribute {
  const range = bits > 0 ? components : 0;
  return {
    name,
    type,
    components,
    bits,
    minimum: Array<number>(range).fill(-1),
    maximum: Array<number>(range).fill(3),
  };
}

const velocity = { form: form('velocity', 'float32', 3, 8), coded: Uint8Array.of(0, 255, 51, 0, 0, 0, 255, 255, 255) };
const age = { form: form('age', 'float32', 1, 12), coded: Uint16Array.of(0, 4095, 819) };
const mass = { form: form('mass', 'float32', 1), coded: Float32Array.of(0.1, -1e30, 7) };
const color = { form: form('color', 'uint8', 4), coded: Uint8Array.of(1, 2, 3, 4, 5, 6, 7, 8, 255, 254, 0, 9) };
const ids = Int32Array.of(-7, 2 ** 31 - 1, -(2 ** 31));
const id = { form: form('id', 'int32', 1), coded: new Uint8Array(ids.buffer) };
const all = [velocity, age, mass, color, id];

/** By the position of its point. */
function values(decoded: DecodedBrick): Map<string, number[]> {
  const { components, values: numbers } = decoded.attribute!;
  return new Map(
    Array.from({ length: pointCount(decoded) }, (_, point) => [
      decoded.positions.subarray(4 * point, 4 * point + 3).join(' '),
      [...numbers.subarray(components * point, components * (point + 1))],
    ]),
  );
}

describe('attributes of a brick', () => {
  it.each([
    [
      'velocity',
      [
        [-1, 3, Math.fround(-1 + (51 * 4) / 255)],
        [-1, -1, -1],
        [3, 3, 3],
      ],
    ],
    ['age', [[-1], [3], [Math.fround(-1 + (819 * 4) / 4095)]]],
    ['mass', [[Math.fround(0.1)], [Math.fround(-1e30)], [7]]],
    [
      'color',
      [
        [1, 2, 3, 4],
        [5, 6, 7, 8],
        [255, 254, 0, 9],
      ],
    ],
    ['id', [[-7], [2 ** 31 - 1], [-(2 ** 31)]]],
  ])('are decoded one at a time, to what they stand for: %s', async (name, expected) => {
    const decoded = decodeBrick({ draco }, await encodeBrick({ ...placed, attributes: all }), offsetBits, name);
    const keys = placed.positions.map((position) => position.join(' '));
    expect(values(decoded)).toEqual(new Map(keys.map((key, i) => [key, expected[i]!])));
  });

  it('are not decoded unless they are asked for', async () => {
    const brick = await encodeBrick({ ...placed, attributes: all });
    expect(decodeBrick({ draco }, brick, offsetBits).attribute).toBeUndefined();
    expect(decodeBrick({ draco }, brick, offsetBits, 'pressure').attribute).toBeUndefined();
  });

  it.each<[string, Partial<CodedAttribute>]>([
    ['not of the type', { type: 'float32', components: 4 }],
    ['not of the type', { components: 3 }],
    ['not of the type', { type: 'uint32', components: 1, bits: 0, name: 'color', minimum: [1] }],
  ])('are refused where the brick lies: %s', async (words, lie) => {
    const brick = await encodeBrick({ ...placed, attributes: [{ ...color, form: { ...color.form, ...lie } }] });
    if (lie.type === 'uint32') {
      // Four bytes: their form is that of an id.
      expect(decodeBrick({ draco }, brick, offsetBits, 'color').attribute!.values).toBeInstanceOf(Uint32Array);
      return;
    }
    expect(() => decodeBrick({ draco }, brick, offsetBits, 'color')).toThrow(words);
    expect(() => decodeBrick({ draco }, brick, offsetBits, 'color')).toThrow('brick (4, 5, 6)');
  });

  it('are refused beyond their bits, without a range, not finite, or missing', async () => {
    const lying = async (name: string, attribute: NonNullable<BrickOptions['attributes']>[number]): Promise<string> => {
      const brick = await encodeBrick({ ...placed, attributes: [attribute] });
      try {
        decodeBrick({ draco }, brick, offsetBits, name);
        return '';
      } catch (error) {
        return String(error);
      }
    };
    expect(await lying('age', { ...age, form: form('age', 'float32', 1, 11) })).toContain(
      '4095, which is beyond 11 bits',
    );
    expect(await lying('age', { ...age, form: { ...age.form, minimum: [], maximum: [] } })).toContain(
      'without a range',
    );
    expect(await lying('mass', { ...mass, coded: Float32Array.of(1, NaN, 2) })).toContain('mass is not finite');
    const brick = await encodeBrick({ ...placed, attributes: [mass] });
    expect(() => decodeBrick({ draco }, { ...brick, attributes: [mass.form, age.form] }, offsetBits, 'age')).toThrow(
      'no attribute age',
    );
  });

  it('survive every cut and every changed byte', async () => {
    const brick = await encodeBrick({ ...placed, attributes: all });
    for (let i = 0; i < brick.data.length; ++i) {
      const changed = brick.data.slice();
      changed[i]! ^= 0x5a;
      for (const data of [changed, brick.data.slice(0, i)])
        for (const {
          form: { name },
        } of [velocity, id])
          try {
            decodeBrick({ draco }, { ...brick, data }, offsetBits, name);
          } catch (error) {
            expect(String(error)).toContain('brick (4, 5, 6)');
          }
    }
    expect(decodeBrick({ draco }, brick, offsetBits, 'id').attribute).toBeDefined();
  });
});

const announcedVelocity: Announced = {
  name: 'velocity',
  type: AttributeType.FLOAT32,
  components: 3,
  minimum: [0, 0, 0],
  maximum: [1, 2, 3],
};

describe('attributes of a mesh', () => {
  const read = (...announced: Announced[]): ReturnType<typeof readAttributes> =>
    readAttributes(
      announced.map((each) => create(MeshAttributeSchema, each)),
      'frame 9',
    );

  it('are those that are announced; bricks have those with bits, in their order', () => {
    const { attributes, coded } = read(
      announcedVelocity,
      { name: 'id', type: AttributeType.UINT32, components: 1, minimum: [1], maximum: [9], bits: 0 },
      { name: 'age', type: AttributeType.FLOAT32, components: 1, bits: 8, codedMinimum: [0], codedMaximum: [4] },
    );
    expect(attributes.map(({ name, carried }) => [name, carried])).toEqual([
      ['velocity', false],
      ['id', true],
      ['age', true],
    ]);
    expect(attributes[0]!.maximum).toEqual([1, 2, 3]);
    expect(coded.map(({ name, bits, maximum }) => [name, bits, maximum])).toEqual([
      ['id', 0, []],
      ['age', 8, [4]],
    ]);
  });

  it.each<[string, Announced]>([
    ['called "Velocity"', { name: 'Velocity' }],
    ['called ""', { name: '' }],
    ['the type 3', { type: 3 as AttributeType }],
    ['the type 0', { type: AttributeType.UNSPECIFIED }],
    ['2 components of float32', { components: 2 }],
    ['3 components of int32', { type: AttributeType.INT32 }],
    ['the range [0, 0] to [1, 2, 3]', { minimum: [0, 0] }],
    ['the range [5, 0, 0]', { minimum: [5, 0, 0] }],
    ['the range [NaN, 0, 0]', { minimum: [NaN, 0, 0] }],
    ['17 bits', { bits: 17 }],
    ['8 bits per component of uint8', { type: AttributeType.UINT8, bits: 8 }],
    ['to [Infinity', { bits: 8, codedMinimum: [0, 0, 0], codedMaximum: [Infinity, 1, 1] }],
    ['for 3 components', { bits: 8, codedMinimum: [0], codedMaximum: [1] }],
  ])('are refused: %s', (words, lie) => {
    expect(() => read({ ...announcedVelocity, ...lie })).toThrow(words);
    expect(() => read({ ...announcedVelocity, ...lie })).toThrow('frame 9');
  });

  it('are at most sixteen, each once', () => {
    expect(() => read(announcedVelocity, announcedVelocity)).toThrow('velocity twice');
    const many = Array.from({ length: 17 }, (_, i) => ({ ...announcedVelocity, name: `a${i}` }));
    expect(() => read(...many)).toThrow('17 attributes');
    expect(read(...many.slice(1)).attributes).toHaveLength(16);
  });

  it('come with their frame, and bricks keep the form that they came with', () => {
    const receiver = new FrameReceiver();
    const taken = (options: Parameters<typeof frame>[0]): Frame =>
      frame(options)
        .map((message) => receiver.take(message, 1, 0))
        .at(-1)!;
    const carried = (high: number): Announced => ({
      ...announcedVelocity,
      bits: 8,
      codedMinimum: [0, 0, 0],
      codedMaximum: [high, high, high],
    });
    const first = taken({ index: 1, bricks: [{ place: [0, 0, 0] }, { place: [1, 0, 0] }], attributes: [carried(4)] });
    expect(first.attributes[0]!.carried).toBe(true);
    const second = taken({ index: 2, base: 1, bricks: [{ place: [1, 0, 0] }], triangles: 2, attributes: [carried(8)] });
    expect([...second.bricks.values()].map(({ attributes }) => attributes[0]!.maximum[0])).toEqual([4, 8]);
  });
});

describe('the store of bricks', () => {
  function fixture(): { store: BrickStore; decoded: (string | undefined)[]; shown: Shown[] } {
    const decoded: (string | undefined)[] = [];
    const shown: Shown[] = [];
    const store = new BrickStore(
      ({ attributes }: EncodedBrick, _: number, name?: string) => {
        decoded.push(name);
        const carried = attributes.some((attribute) => attribute.name === name);
        return Promise.resolve((carried ? { attribute: { name } } : {}) as DecodedBrick);
      },
      {
        shown: (state) => shown.push(state),
        failed: (error) => {
          throw error;
        },
      },
    );
    return { store, decoded, shown };
  }
  const settled = (): Promise<void> => new Promise((resolve) => setTimeout(resolve, 0));
  const frameOf = (attributes: Announced[]): Frame => {
    const receiver = new FrameReceiver();
    return frame({ index: 1, bricks: [{ place: [0, 0, 0] }], attributes })
      .map((message) => receiver.take(message, 1, 0))
      .at(-1)!;
  };
  const carried = { ...announcedVelocity, bits: 0 };

  it('decodes what is shown again for another attribute, and only for one that it carries', async () => {
    const { store, decoded, shown } = fixture();
    store.show(frameOf([carried]));
    await settled();
    for (const name of ['velocity', undefined, 'velocity', 'age', undefined]) {
      store.setAttribute(name);
      await settled();
    }
    expect(decoded).toEqual([undefined, 'velocity']);
    expect(shown.at(-1)!.bricks.get('0,0,0')!.decoded.attribute?.name).toBe('velocity');
  });

  it('does not go back to an older frame for it', async () => {
    const { store, shown } = fixture();
    store.show({ ...frameOf([carried]), index: 1n });
    await settled();
    store.show({ ...frameOf([carried]), index: 2n });
    store.setAttribute('velocity');
    await settled();
    expect(shown.map((state) => [state.frame.index, state.bricks.get('0,0,0')!.decoded.attribute?.name])).toEqual([
      [1n, undefined],
      [2n, undefined],
      [2n, 'velocity'],
    ]);
  });
});

describe('options of a watch', () => {
  it('name an attribute where one is chosen, with fewer bits on the way to less', () => {
    expect(watchOptions('full', 6)).toEqual({});
    expect(watchOptions('full', 0, 'age')).toEqual({ attributes: [{ name: 'age', bits: 12 }] });
    expect(watchOptions('light', 6, 'age')).toMatchObject({ positionBits: 4, attributes: [{ name: 'age', bits: 8 }] });
  });
});
