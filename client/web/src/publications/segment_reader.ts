// A segment of a publication: the messages of its frames, once all of its bytes are what the manifest has announced.
import { fromBinary } from '@bufbuild/protobuf';
import type { Frame } from '../bricks/frame';
import { FrameReceiver } from '../bricks/frame_receiver';
import { ProtocolError } from '../bricks/protocol_error';
import { SegmentBeginSchema, type SegmentFrame } from '../gen/meniscus/v1/publication_pb';
import { WatchResponseSchema } from '../gen/meniscus/v1/surface_service_pb';
import { segmentName, type Segment } from './manifest';

const magic = 'Meniscus segment\n';
const version = 1;

export class SegmentReader {
  private constructor(
    private readonly segment: Segment,
    private readonly frames: readonly SegmentFrame[],
    private readonly messages: Uint8Array,
  ) {}

  /** Throws ProtocolError unless the bytes have the length, the hash and the index that the manifest says. */
  static async open(segment: Segment, bytes: Uint8Array): Promise<SegmentReader> {
    const fail = (what: string): never => {
      throw new ProtocolError(`${segmentName(segment)}: ${what}`);
    };
    if (bytes.length !== segment.bytes)
      fail(`it has ${bytes.length} bytes; the manifest says ${segment.bytes}: it was cut or changed`);
    if (((await sha256Of(bytes)) ?? segment.sha256) !== segment.sha256)
      fail('it does not have the SHA-256 of its name: it was changed');
    if (new TextDecoder().decode(bytes.subarray(0, magic.length)) !== magic) fail('it is not a segment');
    const begin = delimited(bytes, magic.length) ?? fail('it has no index of its frames');
    const index = parsed(begin.message) ?? fail('it has no index of its frames');
    if (index.version !== version)
      fail(`it is of format version ${index.version}; this viewer reads version ${version}`);
    const messages = bytes.subarray(begin.end);
    const wrong = faultOf(index.frames, segment, messages.length);
    if (wrong !== undefined) fail(wrong);
    return new SegmentReader(segment, index.frames, messages);
  }

  /** All frames, in order; those before `first` are read, since others may be differences to them, and not given. */
  *from(first: number): Generator<Frame> {
    const receiver = new FrameReceiver();
    for (let i = 0; i < this.frames.length; ++i) {
      const frame = this.read(this.frames[i]!, receiver);
      if (i >= first) yield frame;
    }
  }

  private read({ index, place, bytes }: SegmentFrame, receiver: FrameReceiver): Frame {
    const end = Number(place + bytes);
    const fail = (what: string): never => {
      throw new ProtocolError(`${segmentName(this.segment)}: frame ${index}: ${what}`);
    };
    let at = Number(place);
    for (;;) {
      const next = delimited(this.messages.subarray(0, end), at) ?? fail('it has no message where one should be');
      const size = next.end - at;
      at = next.end;
      const frame = this.take(next.message, size, receiver, fail);
      if (!frame) continue;
      if (at !== end) fail(`it ends ${end - at} bytes before its end`);
      if (frame.index !== index) fail(`its messages are frame ${frame.index}`);
      return frame;
    }
  }

  private take(
    message: Uint8Array,
    bytes: number,
    receiver: FrameReceiver,
    fail: (what: string) => never,
  ): Frame | undefined {
    try {
      return receiver.take(fromBinary(WatchResponseSchema, message), bytes, performance.now());
    } catch (error) {
      return fail(error instanceof Error ? error.message : String(error));
    }
  }
}

/** The index's fault, in words; none: it has none. bytes: of the frames' messages. */
function faultOf(frames: readonly SegmentFrame[], segment: Segment, bytes: number): string | undefined {
  if (frames.length !== segment.frames) return `it has ${frames.length} frames; the manifest says ${segment.frames}`;
  let end = 0n;
  let before = -1n;
  for (const frame of frames) {
    if (frame.index <= before) return `frame ${frame.index} comes after frame ${before}; indices rise`;
    if (frame.place !== end || frame.bytes > BigInt(bytes) - end)
      return `frame ${frame.index} has ${frame.bytes} bytes at ${frame.place}, which are not there`;
    end += frame.bytes;
    before = frame.index;
  }
  if (end !== BigInt(bytes)) return `its frames have ${end} bytes of ${bytes}`;
  if (frames[0]!.index !== segment.firstFrame || before !== segment.lastFrame)
    return `its frames are not those from ${segment.firstFrame} to ${segment.lastFrame} that the manifest says`;
  return undefined;
}

function parsed(message: Uint8Array) {
  try {
    return fromBinary(SegmentBeginSchema, message);
  } catch {
    return undefined;
  }
}

/** The message whose length stands at `at`; none unless all of it is there. */
function delimited(bytes: Uint8Array, at: number): { message: Uint8Array; end: number } | undefined {
  let length = 0;
  for (let shift = 1; at < bytes.length && shift <= 2 ** 28; shift *= 128) {
    const byte = bytes[at++]!;
    length += (byte & 0x7f) * shift;
    if (byte < 0x80)
      return length <= bytes.length - at ? { message: bytes.subarray(at, at + length), end: at + length } : undefined;
  }
  return undefined;
}

/**
 * In lower case. Browsers compute none for a page that came by plain HTTP from another machine: then none is compared.
 */
async function sha256Of(bytes: Uint8Array): Promise<string | undefined> {
  const subtle = (globalThis.crypto as Partial<Crypto> | undefined)?.subtle;
  if (!subtle) return undefined;
  const digest = new Uint8Array(await subtle.digest('SHA-256', bytes as Uint8Array<ArrayBuffer>));
  return [...digest].map((byte) => byte.toString(16).padStart(2, '0')).join('');
}
