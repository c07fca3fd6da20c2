// Where the lattice codec's decoder lies; none in a viewer that was built without a compiler for WebAssembly.
const files = import.meta.glob<string>('../gen/lattice_decoder.wasm', {
  query: '?url',
  import: 'default',
  eager: true,
});

export const latticeDecoderUrl: string | undefined = Object.values(files)[0];
