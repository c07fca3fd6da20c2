// Decodes bricks beside the page's thread.
import createDraco, { type DracoModule } from 'draco3d/draco_decoder_nodejs.js';
import dracoUrl from 'draco3d/draco_decoder.wasm?url';
import { decodeBrick, type Decoders } from './decode_brick';
import { LatticeModule } from './lattice_module';
import { latticeDecoderUrl } from './lattice_url';
import type { DecodeAnswer, DecodeRequest } from './messages';

async function load(url: string, name: string): Promise<ArrayBuffer> {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`the ${name} decoder could not be loaded: HTTP status ${response.status}`);
  return response.arrayBuffer();
}

const dracoBytes = load(dracoUrl, 'Draco');
const latticeCode = latticeDecoderUrl && load(latticeDecoderUrl, 'lattice').then((bytes) => WebAssembly.compile(bytes));

async function startDecoders(): Promise<Decoders> {
  const draco: Promise<DracoModule> = dracoBytes.then((wasmBinary) => createDraco({ wasmBinary }));
  const lattice = latticeCode && (await LatticeModule.start(await latticeCode));
  return { draco: await draco, ...(lattice ? { lattice } : {}) };
}
let decoders = startDecoders();

async function answer(request: DecodeRequest): Promise<DecodeAnswer> {
  try {
    return { decoded: decodeBrick(await decoders, request.brick, request.offsetBits, request.attribute) };
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
      if (reply.decoded.attribute) moved.push(reply.decoded.attribute.values.buffer);
    }
    postMessage(reply, { transfer: moved });
  });
});
