// One brick from its bytes, by its codec.
import type { DracoModule } from 'draco3d/draco_decoder_nodejs.js';
import type { EncodedBrick } from '../bricks/frame';
import { Codec } from '../gen/meniscus/v1/mesh_pb';
import { decodeDracoBrick } from './decode_draco_brick';
import { decodeLatticeBrick } from './decode_lattice_brick';
import type { DecodedBrick } from './decoded_brick';
import type { LatticeModule } from './lattice_module';

export interface Decoders {
  readonly draco: DracoModule;
  /** None in a viewer that was built without it. */
  readonly lattice?: LatticeModule | undefined;
}

/** name: of the attribute that is decoded, too, where the brick carries it. Throws an Error that names the brick. */
export function decodeBrick(
  { draco, lattice }: Decoders,
  brick: EncodedBrick,
  offsetBits: number,
  name?: string,
): DecodedBrick {
  try {
    if (brick.codec === Codec.DRACO) return decodeDracoBrick(draco, brick, offsetBits, name);
    if (lattice && (brick.codec === Codec.LATTICE_PACKED || brick.codec === Codec.LATTICE_ENTROPY))
      return decodeLatticeBrick(lattice, brick, offsetBits, name);
    throw new Error(`this viewer does not know its codec, ${brick.codec}`);
  } catch (error) {
    throw new Error(`brick (${brick.place.join(', ')}): ${error instanceof Error ? error.message : String(error)}`);
  }
}
