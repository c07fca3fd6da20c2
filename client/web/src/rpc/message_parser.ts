// Cuts the body of a gRPC-Web response into its messages: a byte of flags, four of length (big-endian), the message.
import { Code, RpcError } from './status';

export interface WireMessage {
  /** The last one: status and metadata, as lines of text. */
  readonly trailers: boolean;
  readonly data: Uint8Array;
}

const headerBytes = 5;
const trailersFlag = 0x80;

export class MessageParser {
  private rest: Uint8Array = new Uint8Array(0);

  /** maxBytes: of one message; a larger one is refused before it is buffered. */
  constructor(private readonly maxBytes: number) {}

  /** The messages that the chunk completes. They share its memory where they can. Throws RpcError. */
  push(chunk: Uint8Array): WireMessage[] {
    let bytes = this.rest.length === 0 ? chunk : concatenate(this.rest, chunk);
    const messages: WireMessage[] = [];
    while (bytes.length >= headerBytes) {
      const flags = bytes[0]!;
      const length = new DataView(bytes.buffer, bytes.byteOffset).getUint32(1);
      if ((flags & ~trailersFlag) !== 0)
        throw new RpcError(
          Code.internal,
          `The server sent a message with flags ${flags}; only plain ones are understood.`,
        );
      if (length > this.maxBytes)
        throw new RpcError(
          Code.resourceExhausted,
          `The server sent a message of ${length} bytes; the limit is ${this.maxBytes}.`,
        );
      if (bytes.length < headerBytes + length) break;
      messages.push({
        trailers: (flags & trailersFlag) !== 0,
        data: bytes.subarray(headerBytes, headerBytes + length),
      });
      bytes = bytes.subarray(headerBytes + length);
    }
    this.rest = bytes;
    return messages;
  }

  /** Whether the body may end here. */
  get atBoundary(): boolean {
    return this.rest.length === 0;
  }
}

function concatenate(a: Uint8Array, b: Uint8Array): Uint8Array {
  const joined = new Uint8Array(a.length + b.length);
  joined.set(a);
  joined.set(b, a.length);
  return joined;
}
