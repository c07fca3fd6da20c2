// How fast whole meshes come over this link.
import type { Frame } from '../bricks/frame';

/** Weight of the newest frame. */
const weight = 0.3;
/** The time of a smaller frame depends more on timers than on the link. */
const smallestBytes = 16 << 10;

export class LinkSpeed {
  private bytesPerMs: number | undefined;
  private fullBytes = 0;
  private fullOffsetBits = 0;

  /** full: whether the frame is of full quality. */
  add(frame: Frame, full: boolean): void {
    const ms = frame.arrivedAt - frame.beganAt;
    if (frame.bytes >= smallestBytes && ms > 0) {
      const speed = frame.bytes / ms;
      this.bytesPerMs = this.bytesPerMs === undefined ? speed : this.bytesPerMs * (1 - weight) + speed * weight;
    }
    if (!full) return;
    this.fullBytes = 0;
    for (const brick of frame.bricks.values()) this.fullBytes += brick.data.length;
    this.fullOffsetBits = frame.offsetBits;
  }

  /** 0 while nothing is known. */
  get secondsPerFullMesh(): number {
    return this.bytesPerMs === undefined ? 0 : this.fullBytes / this.bytesPerMs / 1000;
  }

  /** The offset bits of the mesh as reconstructed; 0 while nothing is known. */
  get offsetBits(): number {
    return this.fullOffsetBits;
  }
}
