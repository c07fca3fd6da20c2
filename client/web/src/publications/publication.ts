// A publication: its manifest as it was read last, and its frames.
import type { Frame } from '../bricks/frame';
import { manifestName, maxManifestBytes, readManifest, segmentAt, segmentName, type Manifest } from './manifest';
import { FileMissing, type PublicationFiles } from './publication_files';
import { SegmentReader } from './segment_reader';

export class Publication {
  /** The segment that was opened last. */
  private opened: { readonly sha256: string; readonly reader: SegmentReader } | undefined;

  private constructor(
    private readonly files: PublicationFiles,
    private read: Manifest,
  ) {}

  static async open(files: PublicationFiles, signal: AbortSignal): Promise<Publication> {
    return new Publication(files, await manifestOf(files, signal));
  }

  get manifest(): Manifest {
    return this.read;
  }

  /** Reads the manifest again. */
  async refresh(signal: AbortSignal): Promise<void> {
    this.read = await manifestOf(this.files, signal);
  }

  /** Frames from a place on. No more is fetched than is taken. */
  async *frames(place: number, count: number, signal: AbortSignal): AsyncGenerator<Frame> {
    for (const end = place + count; place < end;) {
      const segment = segmentAt(this.read, place);
      if (!segment) throw new FileMissing(`There is no frame at place ${place} any more.`);
      if (this.opened?.sha256 !== segment.sha256) {
        const bytes = await this.files.read(segmentName(segment), segment.bytes, signal);
        this.opened = { sha256: segment.sha256, reader: await SegmentReader.open(segment, bytes) };
      }
      for (const frame of this.opened.reader.from(place - segment.first)) {
        yield frame;
        if (++place === end) return;
      }
    }
  }
}

async function manifestOf(files: PublicationFiles, signal: AbortSignal): Promise<Manifest> {
  return readManifest(await files.read(manifestName, maxManifestBytes, signal));
}
