// Decodes all bricks of a mesh with one codec after the other, in turn, as the viewer's workers do.
import { decodeBrick } from '../src/decode/decode_brick';
import { startDecoders } from '../src/decode/start_decoders';
import type { CodedMesh, Times } from './messages';

async function measure({ bricks, offsetBits, rounds }: CodedMesh): Promise<Times> {
  const decoders = await startDecoders();
  const times = new Map([...bricks.keys()].map((codec): [number, number[]] => [codec, []]));
  for (let round = 0; round <= rounds; ++round)
    for (const [codec, encoded] of bricks) {
      const start = performance.now();
      for (const brick of encoded) decodeBrick(decoders, brick, offsetBits);
      // The first round compiles.
      if (round > 0) times.get(codec)!.push(performance.now() - start);
    }
  return times;
}

addEventListener('message', ({ data }: MessageEvent<CodedMesh>) => {
  void measure(data).then((times) => {
    postMessage(times);
  });
});
