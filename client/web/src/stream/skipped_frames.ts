// Counts the frames of a run that were not shown, by the gaps in their indices: newer ones replaced them at the server, on the way or
// here.
import type { Frame } from '../bricks/frame';

export class SkippedFrames {
  private last: Pick<Frame, 'runId' | 'index'> | undefined;
  private skipped = 0;

  get count(): number {
    return this.skipped;
  }

  shown(frame: Pick<Frame, 'runId' | 'index'>): void {
    if (this.last?.runId === frame.runId && frame.index > this.last.index)
      this.skipped += Number(frame.index - this.last.index - 1n);
    this.last = frame;
  }

  /** Frames between now and the next one are not wanted, and do not count. */
  pause(): void {
    this.last = undefined;
  }
}
