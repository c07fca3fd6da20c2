// The last frames, to step and scrub through.
import type { EncodedBrick, Frame } from './frame';

export interface HistoryLimits {
  readonly frames: number;
  /** Most bytes of encoded bricks and spray. */
  readonly bytes: number;
}

export class History {
  private readonly kept: Frame[] = [];
  private readonly uses = new Map<EncodedBrick, number>();
  private held = 0;

  constructor(private readonly limits: HistoryLimits) {}

  get frames(): readonly Frame[] {
    return this.kept;
  }

  /** The size of the spray and of the encoded bricks, each counted once however many frames share it. */
  get bytes(): number {
    return this.held;
  }

  /** A frame of the same run and index takes the place of the one before: the same moment, at another quality. */
  add(frame: Frame): void {
    const last = this.kept.at(-1);
    if (last && last.runId === frame.runId && last.index === frame.index) this.release(this.kept.pop()!);
    this.kept.push(frame);
    this.held += frame.spray.byteLength;
    for (const brick of frame.bricks.values()) {
      const uses = this.uses.get(brick) ?? 0;
      if (uses === 0) this.held += brick.data.length;
      this.uses.set(brick, uses + 1);
    }
    while (this.kept.length > 1 && (this.kept.length > this.limits.frames || this.held > this.limits.bytes))
      this.release(this.kept.shift()!);
  }

  clear(): void {
    this.kept.length = 0;
    this.uses.clear();
    this.held = 0;
  }

  private release(frame: Frame): void {
    this.held -= frame.spray.byteLength;
    for (const brick of frame.bricks.values()) {
      const uses = this.uses.get(brick)! - 1;
      if (uses > 0) {
        this.uses.set(brick, uses);
        continue;
      }
      this.uses.delete(brick);
      this.held -= brick.data.length;
    }
  }
}
