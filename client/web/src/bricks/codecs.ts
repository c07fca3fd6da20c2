// The codecs of bricks that this viewer decodes, and those that it asks for.
import { latticeDecoderUrl } from '../decode/lattice_url';
import { Codec } from '../gen/meniscus/v1/mesh_pb';

const latticeCodecs: readonly Codec[] =
  latticeDecoderUrl === undefined ? [] : [Codec.LATTICE_ENTROPY, Codec.LATTICE_PACKED];

/** The smallest first. */
export const knownCodecs: readonly Codec[] = [...latticeCodecs, Codec.DRACO];

export function isKnownCodec(codec: Codec): boolean {
  return knownCodecs.includes(codec);
}

const byName: ReadonlyMap<string | null, Codec> = new Map([
  ['draco', Codec.DRACO],
  ['packed', Codec.LATTICE_PACKED],
  ['entropy', Codec.LATTICE_ENTROPY],
]);

/**
 * Those to ask for, of which a server offers some: the preferred one first, Draco last. Over a link decoders wait for bytes; on the
 * server's own machine it is the other way round. `?codec=packed` in the page's address asks for that one.
 */
export function wantedCodecs(
  { hostname, search }: Pick<Location, 'hostname' | 'search'>,
  known: readonly Codec[] = knownCodecs,
): Codec[] {
  const named = byName.get(new URLSearchParams(search).get('codec'));
  const order = isLoopback(hostname)
    ? [Codec.LATTICE_PACKED, Codec.LATTICE_ENTROPY, Codec.DRACO]
    : [Codec.LATTICE_ENTROPY, Codec.LATTICE_PACKED, Codec.DRACO];
  return order.filter(
    (codec) => known.includes(codec) && (named === undefined || codec === named || codec === Codec.DRACO),
  );
}

function isLoopback(hostname: string): boolean {
  return /^(.+\.)?localhost$|^127(\.\d+){3}$|^\[::1\]$/.test(hostname);
}
