// The particles of the last frames, so that those of the frame on the screen are found.
import type { Frame } from '../bricks/frame';
import type { Particles } from './particles';

export interface KeptLimits {
  readonly frames: number;
  readonly bytes: number;
}

export class KeptParticles {
  private kept: Particles[] = [];
  private bytes = 0;

  constructor(private readonly limits: KeptLimits) {}

  add(particles: Particles): void {
    this.kept.push(particles);
    this.bytes += size(particles);
    while (this.kept.length > 1 && (this.kept.length > this.limits.frames || this.bytes > this.limits.bytes))
      this.bytes -= size(this.kept.shift()!);
  }

  /** The particles of the frame, or else of the frame nearest to it in its run: the two streams may skip different frames. */
  nearest(frame: Pick<Frame, 'runId' | 'index'>): Particles | undefined {
    let best: Particles | undefined;
    for (const particles of this.kept)
      if (particles.runId === frame.runId && (!best || distance(particles, frame) <= distance(best, frame)))
        best = particles;
    return best;
  }

  clear(): void {
    this.kept = [];
    this.bytes = 0;
  }
}

function size({ positions, levels }: Particles): number {
  return positions.byteLength + (levels?.byteLength ?? 0);
}

function distance({ index }: Particles, frame: Pick<Frame, 'index'>): bigint {
  return index < frame.index ? frame.index - index : index - frame.index;
}
