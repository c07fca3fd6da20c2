// Decodes bricks beside the page's thread.
import { withNormals } from './computed_normals';
import { decodeBrick } from './decode_brick';
import type { DecodeAnswer, DecodeRequest } from './messages';
import { startDecoders } from './start_decoders';

let decoders = startDecoders();

async function answer(request: DecodeRequest): Promise<DecodeAnswer> {
  try {
    const decoded = decodeBrick(await decoders, request.brick, request.offsetBits, request.attribute);
    return { decoded: withNormals(decoded, request.offsetBits) };
  } catch (error) {
    // A brick that lies may have broken a decoder's memory, which is not used again.
    decoders = startDecoders();
    return { error: error instanceof Error ? error.message : String(error) };
  }
}

addEventListener('message', (event: MessageEvent<DecodeRequest>) => {
  void answer(event.data).then((reply) => {
    const moved: Transferable[] = [];
    if ('decoded' in reply) {
      moved.push(reply.decoded.positions.buffer, reply.decoded.indices.buffer);
      if (reply.decoded.normals) moved.push(reply.decoded.normals.buffer);
      if (reply.decoded.border) moved.push(reply.decoded.border.points.buffer, reply.decoded.border.sums.buffer);
      if (reply.decoded.attribute) moved.push(reply.decoded.attribute.values.buffer);
    }
    postMessage(reply, { transfer: moved });
  });
});
