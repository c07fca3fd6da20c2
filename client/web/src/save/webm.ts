// A WebM file of one track of encoded pictures. Browsers encode them (WebCodecs) but write no file; what they need of Matroska is little.

export interface EncodedPicture {
  readonly data: Uint8Array;
  /** Whether it can be shown without those before it. */
  readonly key: boolean;
}

export interface Video {
  /** Pixels. */
  readonly width: number;
  readonly height: number;
  /** As Matroska names it. */
  readonly codec: 'V_VP8' | 'V_VP9';
  /** Pictures a second. */
  readonly rate: number;
  /** The first one is a key picture. */
  readonly pictures: readonly EncodedPicture[];
}

/** Times in the file are counted in these: nanoseconds. */
const tick = 1_000_000;
/** A cluster's blocks have their times in 16 bits, relative to that of the cluster: ms. */
const longestCluster = 30_000;
/** Digits of a size that is not known before what follows it. */
const sizeBytes = 8;

type Bytes = Uint8Array;

export function writeWebm({ width, height, codec, rate, pictures }: Video): Bytes {
  const time = (picture: number): number => Math.round((1000 * picture) / rate);
  const head = element(0x1a45dfa3, [
    element(0x4286, uint(1)), // EBMLVersion
    element(0x42f7, uint(1)), // EBMLReadVersion
    element(0x42f2, uint(4)), // EBMLMaxIDLength
    element(0x42f3, uint(8)), // EBMLMaxSizeLength
    element(0x4282, text('webm')), // DocType
    element(0x4287, uint(2)), // DocTypeVersion
    element(0x4285, uint(2)), // DocTypeReadVersion
  ]);
  const information = element(0x1549a966, [
    element(0x2ad7b1, uint(tick)), // TimestampScale
    element(0x4489, double((1000 * pictures.length) / rate)), // Duration
    element(0x4d80, text('Meniscus')), // MuxingApp
    element(0x5741, text('Meniscus')), // WritingApp
  ]);
  const tracks = element(0x1654ae6b, [
    element(0xae, [
      element(0xd7, uint(1)), // TrackNumber
      element(0x73c5, uint(1)), // TrackUID
      element(0x83, uint(1)), // TrackType: video
      element(0x9c, uint(0)), // FlagLacing
      element(0x86, text(codec)), // CodecID
      element(0x23e383, uint(Math.round(1e9 / rate))), // DefaultDuration
      element(0xe0, [element(0xb0, uint(width)), element(0xba, uint(height))]), // Video
    ]),
  ]);
  const clusters = clustersOf(pictures, time).map(({ first, count }) => ({
    time: time(first),
    bytes: element(0x1f43b675, [
      element(0xe7, uint(time(first))), // Timestamp
      ...pictures.slice(first, first + count).map((picture, i) => block(picture, time(first + i) - time(first))),
    ]),
  }));
  // The list of places to begin at lies before them: its own length does not depend on what is in it.
  const cuesAt = (from: number): Bytes => {
    let at = from;
    return element(
      0x1c53bb6b,
      clusters.map((cluster) => {
        const cue = element(0xbb, [
          element(0xb3, uint(cluster.time)), // CueTime
          element(0xb7, [element(0xf7, uint(1)), element(0xf1, uint(at))]), // CueTrackPositions
        ]);
        at += cluster.bytes.length;
        return cue;
      }),
    );
  };
  const before = information.length + tracks.length;
  const cues = cuesAt(before + cuesAt(0).length);
  return concatenate([head, element(0x18538067, [information, tracks, cues, ...clusters.map(({ bytes }) => bytes)])]);
}

/** Each begins with a key picture. */
function clustersOf(
  pictures: readonly EncodedPicture[],
  time: (picture: number) => number,
): { first: number; count: number }[] {
  const clusters: { first: number; count: number }[] = [];
  pictures.forEach(({ key }, i) => {
    const last = clusters.at(-1);
    if (last && !key && time(i) - time(last.first) > longestCluster)
      throw new Error(`picture ${i} comes more than ${longestCluster} ms after the last key picture`);
    if (key || !last) clusters.push({ first: i, count: 1 });
    else ++last.count;
  });
  return clusters;
}

/** SimpleBlock. time: relative to that of the cluster. */
function block({ data, key }: EncodedPicture, time: number): Bytes {
  return element(0xa3, [new Uint8Array([0x81, time >> 8, time & 0xff, key ? 0x80 : 0]), data]);
}

function element(id: number, content: Bytes | readonly Bytes[]): Bytes {
  const parts = content instanceof Uint8Array ? [content] : content;
  const size = parts.reduce((sum, part) => sum + part.length, 0);
  return concatenate([bytesOf(id, Math.ceil((32 - Math.clz32(id)) / 8)), sizeOf(size), ...parts]);
}

/** A size in seven bytes of digits, behind a byte with their number. */
function sizeOf(size: number): Bytes {
  const bytes = bytesOf(size, sizeBytes);
  bytes[0] = 0x01;
  return bytes;
}

/** A number of one length, whatever the value: the bytes behind keep their place. */
function uint(value: number): Bytes {
  return bytesOf(value, 6);
}

function bytesOf(value: number, count: number): Bytes {
  const bytes = new Uint8Array(count);
  for (let i = count - 1; i >= 0; --i) {
    bytes[i] = value % 256;
    value = Math.floor(value / 256);
  }
  return bytes;
}

function double(value: number): Bytes {
  const bytes = new Uint8Array(8);
  new DataView(bytes.buffer).setFloat64(0, value);
  return bytes;
}

function text(value: string): Bytes {
  return new TextEncoder().encode(value);
}

function concatenate(parts: readonly Bytes[]): Bytes {
  const whole = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    whole.set(part, at);
    at += part.length;
  }
  return whole;
}
