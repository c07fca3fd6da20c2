// The decoders that the viewer ships, in a worker.
import createDraco from 'draco3d/draco_decoder_nodejs.js';
import dracoUrl from 'draco3d/draco_decoder.wasm?url';
import type { Decoders } from './decode_brick';
import { LatticeModule } from './lattice_module';
import { latticeDecoderUrl } from './lattice_url';

async function load(url: string, name: string): Promise<ArrayBuffer> {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`the ${name} decoder could not be loaded: HTTP status ${response.status}`);
  return response.arrayBuffer();
}

const dracoBytes = load(dracoUrl, 'Draco');
const latticeCode =
  latticeDecoderUrl === undefined
    ? undefined
    : load(latticeDecoderUrl, 'lattice').then((bytes) => WebAssembly.compile(bytes));

/** New ones, with memory of their own. */
export async function startDecoders(): Promise<Decoders> {
  const draco = dracoBytes.then((wasmBinary) => createDraco({ wasmBinary }));
  const lattice = latticeCode && LatticeModule.start(await latticeCode);
  return { draco: await draco, lattice: await lattice };
}
