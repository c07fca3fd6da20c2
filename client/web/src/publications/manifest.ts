// A publication's manifest, of which nothing is believed. proto/README.md has the format.
import { fromJsonString } from '@bufbuild/protobuf';
import { ProtocolError } from '../bricks/protocol_error';
import { PublicationSchema, type PublishedSegment } from '../gen/meniscus/v1/publication_pb';
import type { SessionDescription } from '../gen/meniscus/v1/session_service_pb';
import type { Settings } from '../gen/meniscus/v1/settings_pb';

export const manifestName = 'manifest.json';
export const maxManifestBytes = 64 << 20;

const format = 'Meniscus publication';
const version = 1;
/** A frame's place is counted exactly. */
const maxPlaces = Number.MAX_SAFE_INTEGER;
/** More than a browser could hold. */
const maxSegmentBytes = 1 << 30;

export interface Segment {
  /** Of its bytes; it names the file. */
  readonly sha256: string;
  readonly bytes: number;
  /** Place of the first frame. */
  readonly first: number;
  /** At least 1. */
  readonly frames: number;
  /** How long they are shown at the pace of publishing. */
  readonly seconds: number;
  readonly firstFrame: bigint;
  readonly lastFrame: bigint;
}

export interface Manifest {
  readonly description: SessionDescription | undefined;
  readonly settings: Settings | undefined;
  readonly live: boolean;
  /** Place of the first frame that is there, and that behind the last one. */
  readonly first: number;
  readonly end: number;
  readonly segments: readonly Segment[];
}

/** The name of a segment's file. */
export function segmentName({ sha256 }: Pick<Segment, 'sha256'>): string {
  return `${sha256}.segment`;
}

/** Throws ProtocolError in one line. */
export function readManifest(bytes: Uint8Array): Manifest {
  const message = parse(bytes);
  if (message.format !== format) throw new ProtocolError('this is not the manifest of a publication');
  if (message.version !== version)
    throw new ProtocolError(
      `this is a publication of format version ${message.version}; this viewer reads version ${version}`,
    );
  if (message.leftFrames > BigInt(maxPlaces)) throw new ProtocolError(`${message.leftFrames} frames have left it`);
  const first = Number(message.leftFrames);
  let end = first;
  const segments = message.segments.map((segment, i) => {
    const checked = check(segment, end, `segment ${i + 1}`);
    end += checked.frames;
    if (end > maxPlaces) throw new ProtocolError('it has more frames than can be counted');
    return checked;
  });
  if (message.frames !== BigInt(end - first))
    throw new ProtocolError(`it says ${message.frames} frames; its segments have ${end - first}`);
  const { description, settings, live } = message;
  return { description, settings, live, first, end, segments };
}

/** The segment that has the frame of this place; none if it is not there. */
export function segmentAt({ segments }: Pick<Manifest, 'segments'>, place: number): Segment | undefined {
  let low = 0;
  let high = segments.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    const { first, frames } = segments[middle]!;
    if (place >= first + frames) low = middle + 1;
    else high = middle;
  }
  const found = segments[low];
  return found && place >= found.first ? found : undefined;
}

function parse(bytes: Uint8Array) {
  try {
    return fromJsonString(PublicationSchema, new TextDecoder('utf-8', { fatal: true }).decode(bytes), {
      ignoreUnknownFields: true,
    });
  } catch {
    throw new ProtocolError('this is not a manifest, or it was cut');
  }
}

function check(wire: PublishedSegment, first: number, name: string): Segment {
  const { sha256, bytes, frames, seconds, firstFrame, lastFrame } = wire;
  if (!/^[0-9a-f]{64}$/.test(sha256)) throw new ProtocolError(`${name} is not named by a SHA-256`);
  if (bytes === 0 || bytes > maxSegmentBytes) throw new ProtocolError(`${name} has ${bytes} bytes`);
  if (frames === 0 || frames > bytes) throw new ProtocolError(`${name} has ${frames} frames in ${bytes} bytes`);
  if (!Number.isFinite(seconds) || seconds < 0) throw new ProtocolError(`${name} is shown for ${seconds} s`);
  if (lastFrame < firstFrame || lastFrame - firstFrame < BigInt(frames - 1))
    throw new ProtocolError(`${name} has ${frames} frames from ${firstFrame} to ${lastFrame}; indices rise`);
  return { sha256, bytes, first, frames, seconds, firstFrame, lastFrame };
}
