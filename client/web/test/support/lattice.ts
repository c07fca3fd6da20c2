// The lattice codec's decoder that the viewer ships; none where it was built without a compiler for WebAssembly.
import { existsSync, readFileSync } from 'node:fs';
import { LatticeModule } from '../../src/decode/lattice_module';

const file = new URL('../../src/gen/lattice_decoder.wasm', import.meta.url);

export async function latticeDecoder(): Promise<LatticeModule | undefined> {
  return existsSync(file) ? LatticeModule.start(await WebAssembly.compile(readFileSync(file))) : undefined;
}
