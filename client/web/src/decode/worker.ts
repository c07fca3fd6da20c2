// Decodes bricks beside the page's thread.
import createModule, { type DracoModule } from 'draco3d/draco_decoder_nodejs.js';
import wasmUrl from 'draco3d/draco_decoder.wasm?url';
import { decodeBrick } from './decode_brick';
import type { DecodeAnswer, DecodeRequest } from './messages';

const wasm: Promise<ArrayBuffer> = fetch(wasmUrl).then((response) => {
  if (!response.ok) throw new Error(`the Draco decoder could not be loaded: HTTP status ${response.status}`);
  return response.arrayBuffer();
});
const startDecoder = async (): Promise<DracoModule> => createModule({ wasmBinary: await wasm });
let draco = startDecoder();

async function answer(request: DecodeRequest): Promise<DecodeAnswer> {
  try {
    return { decoded: decodeBrick(await draco, request.brick, request.offsetBits, request.attribute) };
  } catch (error) {
    // A brick that lies may have broken the decoder's memory, which is not used again.
    draco = startDecoder();
    return { error: error instanceof Error ? error.message : String(error) };
  }
}

addEventListener('message', (event: MessageEvent<DecodeRequest>) => {
  void answer(event.data).then((reply) => {
    const moved: Transferable[] = [];
    if ('decoded' in reply) {
      moved.push(reply.decoded.positions.buffer, reply.decoded.indices.buffer);
      if (reply.decoded.normals) moved.push(reply.decoded.normals.buffer);
      if (reply.decoded.attribute) moved.push(reply.decoded.attribute.values.buffer);
    }
    postMessage(reply, { transfer: moved });
  });
});
