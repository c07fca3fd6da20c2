// Keeps what is shown from going back in time.
import type { Frame } from '../bricks/frame';

export class FrameOrder {
  private runId = 0n;
  private index = -1n;

  /** Whether the frame may be shown after those before it. Across calls only runs with a name can be compared. */
  admits(frame: Pick<Frame, 'runId' | 'index'>): boolean {
    if (frame.runId !== 0n && frame.runId === this.runId && frame.index < this.index) return false;
    this.runId = frame.runId;
    this.index = frame.index;
    return true;
  }
}
