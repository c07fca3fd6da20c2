// The codecs of bricks that this viewer decodes.
import { Codec } from '../gen/meniscus/v1/mesh_pb';

/** The one that is preferred first. */
export const knownCodecs: readonly Codec[] = [Codec.DRACO];

export function isKnownCodec(codec: Codec): boolean {
  return knownCodecs.includes(codec);
}
