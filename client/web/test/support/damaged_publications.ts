// Damaged manifests and segments, the same in every run: cut, changed and spliced, all behind hashes that fit.
import { ProtocolError } from '../../src/bricks/protocol_error';
import { Publication } from '../../src/publications/publication';
import { FileMissing } from '../../src/publications/publication_files';
import { golden, inMemory, segmentOf, withSegment } from './published';

export interface Outcome {
  /** All frames were read: the damage was to what says nothing of them. */
  read: number;
  /** ProtocolError, or a file that is not there. */
  refused: number;
}

const { signal } = new AbortController();

/** Reads `rounds` publications, of which each second one has a damaged segment. Throws what else a reader throws. */
export async function readDamaged(
  rounds: number,
  seed: number,
  progress: (done: number) => void = () => undefined,
): Promise<{ manifests: Outcome; segments: Outcome }> {
  const files = golden();
  const segment = segmentOf(files);
  const random = generator(seed);
  const manifests = { read: 0, refused: 0 };
  const segments = { read: 0, refused: 0 };
  for (let round = 0; round < rounds; ++round) {
    const inSegment = round % 2 === 0;
    const name = inSegment ? segment : 'manifest.json';
    const bytes = damaged(files[name]!, random);
    const broken = inSegment ? withSegment(files, bytes) : { ...files, [name]: bytes };
    const outcome = inSegment ? segments : manifests;
    try {
      const publication = await Publication.open(inMemory(broken), signal);
      const { first, end } = publication.manifest;
      for await (const frame of publication.frames(first, Math.min(end - first, 2), signal)) void frame;
      ++outcome.read;
    } catch (error) {
      if (!(error instanceof ProtocolError) && !(error instanceof FileMissing))
        throw new Error(`round ${round} of seed ${seed}`, { cause: error });
      ++outcome.refused;
    }
    progress(round + 1);
  }
  return { manifests, segments };
}

type Random = (below: number) => number;

function generator(seed: number): Random {
  let state = seed;
  return (below) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return Math.floor((state / 2 ** 32) * below);
  };
}

function damaged(whole: Uint8Array, random: Random): Uint8Array {
  let bytes = whole.slice();
  for (let i = random(4); i >= 0; --i) {
    const at = random(bytes.length);
    const kind = random(5);
    if (kind === 0) bytes[at] = random(256);
    else if (kind === 1)
      bytes[at]! ^= 1 << random(4); // of a digit another one, mostly
    else if (kind === 2) bytes = bytes.slice(0, at + 1);
    else if (kind === 3) bytes.copyWithin(at, random(bytes.length), bytes.length);
    else bytes = twice(bytes, at >> 1, at);
  }
  return bytes;
}

/** With a part once more. */
function twice(bytes: Uint8Array, begin: number, end: number): Uint8Array<ArrayBuffer> {
  const longer = new Uint8Array(bytes.length + end - begin);
  longer.set(bytes.subarray(0, end));
  longer.set(bytes.subarray(begin), end);
  return longer;
}
