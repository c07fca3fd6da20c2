// What the benchmark's page sends to its worker, and what comes back.
import type { EncodedBrick } from '../src/bricks/frame';

/** The bricks of one mesh with each codec, by its number. */
export interface CodedMesh {
  readonly offsetBits: number;
  readonly bricks: ReadonlyMap<number, readonly EncodedBrick[]>;
  readonly rounds: number;
}

/** The ms of each round, by codec. */
export type Times = ReadonlyMap<number, readonly number[]>;
