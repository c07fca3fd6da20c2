// Pictures, one after the other, each shown for as long as the others, to a video file.
import { writeWebm, type EncodedPicture } from './webm';

/** Preferred first. Level 5.1: up to 4096 x 2176 pixels. */
const codecs = [
  { name: 'vp09.00.51.08', id: 'V_VP9' },
  { name: 'vp8', id: 'V_VP8' },
] as const;
/** The rate of the compressed video, where pictures are as restless as water. */
const bitsPerPixel = 0.2;
/** From one picture that can be sought to the next one. */
const keySeconds = 2;
/** Pictures that wait for the encoder; more would only take memory. */
const longestQueue = 4;

/** Why there is no video, for people; undefined where there can be one. */
export function whyNoEncoder(scope: { VideoEncoder?: unknown; isSecureContext: boolean }): string | undefined {
  if (scope.VideoEncoder !== undefined) return undefined;
  return scope.isSecureContext
    ? 'This browser cannot encode videos (it has no WebCodecs). Another one may.'
    : 'Browsers encode videos only for pages that came by HTTPS or from the same machine.';
}

export class VideoFile {
  private readonly pictures: EncodedPicture[] = [];
  private readonly encoder: VideoEncoder;
  private readonly keyInterval: number;
  private added = 0;
  private failure: Error | undefined;

  private constructor(
    private readonly size: { readonly width: number; readonly height: number },
    private readonly rate: number,
    config: VideoEncoderConfig,
    private readonly codec: 'V_VP8' | 'V_VP9',
  ) {
    this.keyInterval = Math.max(1, Math.round(keySeconds * rate));
    this.encoder = new VideoEncoder({
      output: (chunk) => {
        const data = new Uint8Array(chunk.byteLength);
        chunk.copyTo(data);
        this.pictures.push({ data, key: chunk.type === 'key' });
      },
      error: (error) => {
        this.failure = error;
        // A waiter for room need not wait any more.
        this.encoder.dispatchEvent(new Event('dequeue'));
      },
    });
    this.encoder.configure(config);
  }

  /** Pixels, even. rate: pictures a second. Throws where the browser encodes none of that size. */
  static async begin(size: { readonly width: number; readonly height: number }, rate: number): Promise<VideoFile> {
    for (const { name, id } of codecs) {
      const config = {
        codec: name,
        ...size,
        framerate: rate,
        bitrate: Math.round(bitsPerPixel * rate * size.width * size.height),
      };
      const { supported } = await VideoEncoder.isConfigSupported(config);
      if (supported) return new VideoFile(size, rate, config, id);
    }
    throw new Error(`This browser encodes no video of ${size.width} x ${size.height} pixels as VP9 or VP8.`);
  }

  async add(canvas: HTMLCanvasElement): Promise<void> {
    while (this.encoder.encodeQueueSize >= longestQueue && !this.failure)
      await new Promise((resolve) => {
        this.encoder.addEventListener('dequeue', resolve, { once: true });
      });
    if (this.failure) throw this.failure;
    const time = (picture: number): number => Math.round((1e6 * picture) / this.rate);
    const picture = new VideoFrame(canvas, {
      timestamp: time(this.added),
      duration: time(this.added + 1) - time(this.added),
    });
    this.encoder.encode(picture, { keyFrame: this.added % this.keyInterval === 0 });
    picture.close();
    ++this.added;
  }

  async finish(): Promise<Uint8Array> {
    await this.encoder.flush();
    if (this.failure) throw this.failure;
    this.encoder.close();
    return writeWebm({ ...this.size, codec: this.codec, rate: this.rate, pictures: this.pictures });
  }

  abandon(): void {
    if (this.encoder.state !== 'closed') this.encoder.close();
  }
}
