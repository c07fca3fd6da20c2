import { beforeAll, describe, expect, it } from 'vitest';
import type { DracoModule } from 'draco3d/draco_decoder_nodejs.js';
import { DecodePool, type DecodeWorker } from '../src/decode/decode_pool';
import { decodeBrick } from '../src/decode/decode_brick';
import { pointCount } from '../src/decode/decoded_brick';
import type { DecodeAnswer, DecodeRequest } from '../src/decode/messages';
import { dracoDecoder, encodeBrick, flat, tetrahedron } from './support/draco';

const offsetBits = 6;
let draco: DracoModule;

beforeAll(async () => {
  draco = await dracoDecoder();
});

/** Its triangles as sorted lists of corners. */
function corners(positions: Uint16Array, indices: ArrayLike<number>): string[] {
  const triangles: string[] = [];
  for (let t = 0; t < indices.length; t += 3) {
    const points = [0, 1, 2].map((i) =>
      [...positions.subarray(4 * indices[t + i]!, 4 * indices[t + i]! + 3)].join(' '),
    );
    const first = points.indexOf([...points].sort()[0]!);
    triangles.push([...points.slice(first), ...points.slice(0, first)].join(' | '));
  }
  return triangles.sort();
}

describe('decodeBrick', () => {
  it('gives back every triangle, exactly and with its orientation', async () => {
    const brick = await tetrahedron([1, 2, 3], 2);
    const decoded = decodeBrick({ draco }, brick, offsetBits);
    const [x, y, z] = [256, 512, 768];
    const p = [
      `${x + 10} ${y + 10} ${z + 10}`,
      `${x + 200} ${y + 20} ${z + 15}`,
      `${x + 30} ${y + 190} ${z + 25}`,
      `${x + 40} ${y + 35} ${z + 210}`,
    ];
    const expected = [
      [0, 2, 1],
      [0, 1, 3],
      [0, 3, 2],
      [1, 2, 3],
    ].map((triangle) => {
      const points = triangle.map((i) => p[i]!);
      const first = points.indexOf([...points].sort()[0]!);
      return [...points.slice(first), ...points.slice(0, first)].join(' | ');
    });
    expect(corners(decoded.positions, decoded.indices)).toEqual(expected.sort());
    expect(decoded.bounds).toEqual({ min: [x + 10, y + 10, z + 10], max: [x + 200, y + 190, z + 210] });
  });

  it('gives unit normals', async () => {
    const { normals } = decodeBrick({ draco }, await tetrahedron([0, 0, 0], 1), offsetBits);
    for (let i = 0; i < normals!.length; i += 4)
      expect(Math.hypot(normals![i]!, normals![i + 1]!, normals![i + 2]!)).toBeCloseTo(32767, -1);
  });

  it('orders triangles by level, crack filling last', async () => {
    // One triangle in cell (0, 0, 0), of level 3; one in cell (1, 0, 0), of level 1; one in the plane between the two.
    const brick = await encodeBrick({
      positions: [
        [256, 10, 10],
        [256, 60, 20],
        [256, 30, 90],
        [100, 40, 40],
        [300, 50, 50],
      ],
      triangles: [
        [0, 1, 3],
        [0, 2, 1],
        [0, 4, 1],
      ],
      levels: [3, 1],
    });
    const decoded = decodeBrick({ draco }, brick, offsetBits);
    expect(decoded.levelTriangles).toEqual([1, 0, 1, 1]);
    const triangle = (t: number): number[] =>
      [0, 1, 2].map((i) => decoded.positions[4 * decoded.indices[3 * t + i]!]!).sort((a, b) => a - b);
    expect([triangle(0), triangle(1), triangle(2)]).toEqual([
      [256, 256, 300],
      [100, 256, 256],
      [256, 256, 256],
    ]);
    expect(decoded.normals).toBeUndefined();
  });

  it.each([
    ['announced were 2', { triangleCount: 2 }],
    ['a brick has at most', { triangleCount: 2 ** 31 }],
    ['does not know its codec, 7', { codec: 7 }],
    ['not a Draco mesh', { data: new Uint8Array([1, 2, 3]) }],
    ['more than 64 per byte', { data: new Uint8Array(0) }],
    ['more than 64 per byte', { triangleCount: 2 ** 20 }],
    [
      'do not fit 1 triangles',
      {
        data: Uint8Array.from([
          0x44, 0x52, 0x41, 0x43, 0x4f, 2, 2, 1, 1, 0, 0, 0, 0xff, 0xff, 0xff, 0xff, 0xf, 1, 0, 1, 0,
        ]),
      },
    ],
    ['bytes of cell levels', { cellLevels: new Uint8Array(0) }],
    ['bytes of cell levels', { cellLevels: Uint8Array.of(1, 0) }],
    ['level 0', { cellLevels: new Uint8Array(1) }],
  ])('refuses a brick that lies: %s', async (words, lie) => {
    const brick = await encodeBrick({ ...flat, place: [4, 5, 6] });
    expect(() => decodeBrick({ draco }, { ...brick, ...lie }, offsetBits)).toThrow(words);
    expect(() => decodeBrick({ draco }, { ...brick, ...lie }, offsetBits)).toThrow('brick (4, 5, 6)');
  });

  it('refuses a vertex outside of the brick', async () => {
    const outside = await encodeBrick({
      ...flat,
      positions: [
        [1, 1, 1],
        [4097, 1, 2],
        [1, 9, 3],
      ],
    });
    expect(() => decodeBrick({ draco }, outside, offsetBits)).toThrow('outside');
  });

  it('survives every cut and every changed byte of a brick', async () => {
    const brick = await tetrahedron([0, 0, 0], 1);
    for (let i = 0; i < brick.data.length; ++i) {
      const changed = brick.data.slice();
      changed[i]! ^= 0x5a;
      for (const bytes of [changed, brick.data.slice(0, i)])
        try {
          expect(pointCount(decodeBrick({ draco }, { ...brick, data: bytes }, offsetBits))).toBeGreaterThan(0);
        } catch (error) {
          expect(String(error)).toContain('brick (0, 0, 0)');
        }
    }
    expect(decodeBrick({ draco }, brick, offsetBits).levelTriangles).toEqual([4, 0, 0, 0]);
  });
});

describe('DecodePool', () => {
  function worker(): DecodeWorker & { requests: DecodeRequest[] } {
    return {
      requests: [],
      onmessage: null,
      onerror: null,
      postMessage(request) {
        this.requests.push(request);
      },
    };
  }

  it('gives each worker one brick at a time and matches answers to bricks', async () => {
    const workers = [worker(), worker()];
    const pool = new DecodePool(workers);
    const bricks = await Promise.all([1, 2, 3].map((x) => tetrahedron([0, 0, 0], 1, [x, 0, 0])));
    const results = bricks.map((brick) => pool.decode(brick, offsetBits));
    expect(workers.map(({ requests }) => requests.length)).toEqual([1, 1]);
    const settle = (which: (typeof workers)[number]): void => {
      const { brick } = which.requests.at(-1)!;
      which.onmessage!({ data: { decoded: decodeBrick({ draco }, brick, offsetBits) } } as MessageEvent<DecodeAnswer>);
    };
    settle(workers[0]!);
    expect(workers[0]!.requests).toHaveLength(2);
    workers[0]!.onmessage!({ data: { error: 'torn' } } as MessageEvent<DecodeAnswer>);
    settle(workers[1]!);
    const outcomes = await Promise.allSettled(results);
    expect(outcomes.map(({ status }) => status).sort()).toEqual(['fulfilled', 'fulfilled', 'rejected']);
  });

  it('rejects a brick whose worker fails, and goes on', async () => {
    const only = worker();
    const pool = new DecodePool([only]);
    const brick = await tetrahedron([0, 0, 0], 1);
    const [first, second] = [pool.decode(brick, offsetBits), pool.decode(brick, offsetBits)];
    only.onerror!({ message: 'out of memory' } as ErrorEvent);
    await expect(first).rejects.toThrow('out of memory');
    only.onmessage!({ data: { decoded: decodeBrick({ draco }, brick, offsetBits) } } as MessageEvent<DecodeAnswer>);
    await expect(second).resolves.toBeDefined();
  });
});
