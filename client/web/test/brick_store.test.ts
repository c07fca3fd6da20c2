import { describe, expect, it } from 'vitest';
import { BrickStore, type Shown } from '../src/bricks/brick_store';
import type { EncodedBrick, Frame } from '../src/bricks/frame';
import { FrameReceiver } from '../src/bricks/frame_receiver';
import type { DecodedBrick } from '../src/decode/decoded_brick';
import { frame as messages, type FrameOptions } from './support/messages';

const decoded = {} as DecodedBrick;
const settled = (): Promise<void> => new Promise((resolve) => setTimeout(resolve, 0));

class Decoder {
  readonly jobs: { brick: EncodedBrick; finish: () => void; fail: () => void }[] = [];
  readonly decode = (brick: EncodedBrick): Promise<DecodedBrick> =>
    new Promise((resolve, reject) => {
      this.jobs.push({
        brick,
        finish: () => {
          resolve(decoded);
        },
        fail: () => {
          reject(new Error('not Draco'));
        },
      });
    });
  finishAll(): Promise<void> {
    for (const job of this.jobs.splice(0)) job.finish();
    return settled();
  }
}

function fixture(): {
  store: BrickStore;
  decoder: Decoder;
  shown: Shown[];
  failures: unknown[];
  frame: (options: FrameOptions) => Frame;
} {
  const decoder = new Decoder();
  const shown: Shown[] = [];
  const failures: unknown[] = [];
  const store = new BrickStore(decoder.decode, {
    shown: (state) => shown.push(state),
    failed: (error) => failures.push(error),
  });
  const receiver = new FrameReceiver();
  const frame = (options: FrameOptions): Frame =>
    messages(options)
      .map((message) => receiver.take(message, 1, 0))
      .at(-1)!;
  return { store, decoder, shown, failures, frame };
}

const bricks: FrameOptions['bricks'] = [{ place: [0, 0, 0] }, { place: [1, 0, 0] }];

describe('BrickStore', () => {
  it('shows a frame when its last brick is decoded, and nothing of it before', async () => {
    const { store, decoder, shown, frame } = fixture();
    store.show(frame({ index: 1, bricks }));
    decoder.jobs[0]!.finish();
    await settled();
    expect(shown).toHaveLength(0);
    decoder.jobs[1]!.finish();
    await settled();
    expect(shown.map((state) => [state.frame.index, state.bricks.size])).toEqual([[1n, 2]]);
  });

  it('decodes only what differs from what is shown', async () => {
    const { store, decoder, shown, frame } = fixture();
    store.show(frame({ index: 1, bricks }));
    await decoder.finishAll();
    store.show(frame({ index: 2, base: 1, bricks: [{ place: [1, 0, 0] }], triangles: 2 }));
    expect(decoder.jobs.map(({ brick }) => brick.place)).toEqual([[1, 0, 0]]);
    await decoder.finishAll();
    expect(shown[1]!.bricks.get('0,0,0')).toBe(shown[0]!.bricks.get('0,0,0'));
  });

  it('goes from a slow frame to the newest', async () => {
    const { store, decoder, shown, frame } = fixture();
    for (let index = 1; index <= 5; ++index) store.show(frame({ index, bricks }));
    await decoder.finishAll();
    await decoder.finishAll();
    expect(shown.map((state) => state.frame.index)).toEqual([1n, 5n]);
  });

  it('shows nothing more of what was there before it was cleared', async () => {
    const { store, decoder, shown, frame } = fixture();
    store.show(frame({ index: 1, bricks }));
    store.show(frame({ index: 2, bricks }));
    store.clear();
    await decoder.finishAll();
    expect([shown.length, store.shown]).toEqual([0, undefined]);
    store.show(frame({ index: 3, bricks }));
    await decoder.finishAll();
    expect(shown.map((state) => state.frame.index)).toEqual([3n]);
  });

  it('shows an empty frame', async () => {
    const { store, shown, frame } = fixture();
    store.show(frame({ index: 1 }));
    await settled();
    expect(shown[0]!.bricks.size).toBe(0);
  });

  it('keeps what it shows when a brick cannot be decoded, and goes on with the next frame', async () => {
    const { store, decoder, shown, failures, frame } = fixture();
    store.show(frame({ index: 1, bricks }));
    await decoder.finishAll();
    store.show(frame({ index: 2, bricks }));
    decoder.jobs.splice(0).forEach((job) => {
      job.fail();
    });
    await settled();
    expect([failures.length, store.shown!.frame.index]).toEqual([1, 1n]);
    store.show(frame({ index: 3, bricks }));
    await decoder.finishAll();
    expect(shown.at(-1)!.frame.index).toBe(3n);
  });
});
