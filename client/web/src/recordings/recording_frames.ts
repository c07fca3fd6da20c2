// The frames of a recording, fetched around the one that is wanted, and kept for a while.
import type { Frame } from '../bricks/frame';

/** Frames from a place on. */
export type ReadFrames = (position: number, count: number, signal: AbortSignal) => AsyncIterable<Frame>;

export interface RecordingFramesEvents {
  /** The frame that is wanted. */
  frame(frame: Frame, position: number): void;
  /** The one that is wanted could not be fetched; nothing is tried until show(). */
  failed(error: unknown): void;
  /** The size of every frame, as it comes. */
  received(bytes: number): void;
}

export interface RecordingFramesLimits {
  /** Fetched from the wanted one on, in one call. */
  readonly ahead: number;
  /** Kept, those used last; more than `ahead`. */
  readonly frames: number;
  /** Most bytes of encoded bricks and spray. */
  readonly bytes: number;
}

/** A call under way: its frames from `next` to `end` are still to come. */
interface Fetch {
  readonly abort: AbortController;
  next: number;
  readonly end: number;
}

export class RecordingFrames {
  /** By place, those used last at the end. */
  private readonly kept = new Map<number, Frame>();
  private held = 0;
  private fetch: Fetch | undefined;
  private wanted: number | undefined;
  private last = 0;

  constructor(
    private count: number,
    private readonly read: ReadFrames,
    private readonly limits: RecordingFramesLimits,
    private readonly events: RecordingFramesEvents,
  ) {}

  get length(): number {
    return this.count;
  }

  /** More frames have come. */
  grow(length: number): void {
    this.count = Math.max(this.count, length);
    if (this.wanted === undefined && this.last > 0) this.fetchAhead();
  }

  /** The latest one that is asked for wins: an earlier one that has not come is not waited for. */
  show(position: number): void {
    const frame = this.kept.get(position);
    this.last = position;
    this.wanted = frame ? undefined : position;
    if (frame) {
      this.keep(position, frame);
      this.events.frame(frame, position);
    } else if (this.fetch && (position < this.fetch.next || position >= this.fetch.end)) {
      this.stop();
      this.wanted = position;
    }
    this.fetchAhead();
  }

  /** A frame as far as it is known without fetching it. */
  at(position: number): Frame | undefined {
    return this.kept.get(position);
  }

  /** Nothing is reported any more, until show(). */
  stop(): void {
    this.fetch?.abort.abort();
    this.fetch = undefined;
    this.wanted = undefined;
  }

  /** Once half of what was fetched ahead has been seen, the next part. */
  private fetchAhead(): void {
    if (this.fetch) return;
    const due = Math.min(this.count, this.last + Math.ceil(this.limits.ahead / 2));
    let first = this.last;
    while (first < due && this.kept.has(first)) ++first;
    if (first === due) return;
    const end = Math.min(this.count, first + this.limits.ahead);
    this.fetch = { abort: new AbortController(), next: first, end };
    void this.run(this.fetch);
  }

  private async run(fetch: Fetch): Promise<void> {
    const { signal } = fetch.abort;
    try {
      for await (const frame of this.read(fetch.next, fetch.end - fetch.next, signal)) {
        if (signal.aborted) return;
        this.events.received(frame.bytes);
        this.take(fetch, frame);
      }
      if (signal.aborted) return;
      if (fetch.next < fetch.end) throw new Error(`The frames have ended before that at place ${fetch.next}.`);
      this.fetch = undefined;
    } catch (error) {
      if (signal.aborted) return;
      this.fetch = undefined;
      // A frame that is fetched ahead is asked for again when it is wanted.
      if (this.wanted !== undefined) this.events.failed(error);
    }
  }

  private take(fetch: Fetch, frame: Frame): void {
    const position = fetch.next++;
    if (!this.keep(position, frame)) {
      fetch.abort.abort();
      this.fetch = undefined;
      return;
    }
    if (position !== this.wanted) return;
    this.wanted = undefined;
    this.events.frame(frame, position);
  }

  /** False, without keeping it, where what is due before it leaves no room. */
  private keep(position: number, frame: Frame): boolean {
    this.drop(position);
    this.kept.set(position, frame);
    this.held += bytesOf(frame);
    for (const oldest of [...this.kept.keys()]) {
      if (this.fits()) return true;
      if (oldest < this.last || oldest >= this.last + this.limits.ahead) this.drop(oldest);
    }
    if (this.fits() || position === this.last) return true;
    this.drop(position);
    return false;
  }

  private fits(): boolean {
    return this.kept.size <= this.limits.frames && this.held <= this.limits.bytes;
  }

  private drop(position: number): void {
    const frame = this.kept.get(position);
    if (!frame) return;
    this.kept.delete(position);
    this.held -= bytesOf(frame);
  }
}

function bytesOf(frame: Frame): number {
  let bytes = frame.spray.byteLength;
  for (const brick of frame.bricks.values()) bytes += brick.data.length;
  return bytes;
}
