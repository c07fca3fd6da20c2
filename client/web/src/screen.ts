// The screen: one frame whole, its figures.
import { BrickStore, type Shown } from './bricks/brick_store';
import type { Frame } from './bricks/frame';
import { levelCount } from './decode/decoded_brick';
import type { DecodePool } from './decode/decode_pool';
import type { Particles } from './particles/particles';
import type { Overlay } from './ui/overlay';
import type { Viewer } from './view/viewer';

export interface ScreenEvents {
  /** A frame has taken the place of the one before. */
  shown(): void;
  failed(reason: string): void;
  /** A frame is shown again after one that failed. */
  recovered(): void;
  /** The first frame is about to be drawn. */
  firstShown(): void;
  /** It has been drawn, and its figures stand beside it. */
  firstFrame(): void;
}

export class Screen {
  private readonly store: BrickStore;
  private failing = false;
  private lastDrawn: Frame | undefined;
  /** Until it has been drawn. */
  private awaited: { readonly frame: Frame; drawn(): void; failed(error: unknown): void } | undefined;

  constructor(
    pool: DecodePool,
    private readonly viewer: Viewer,
    readonly overlay: Overlay,
    private readonly events: ScreenEvents,
  ) {
    this.store = new BrickStore((...what) => pool.decode(...what), {
      shown: (shown) => {
        this.viewer.show(shown);
        if (!this.lastDrawn) this.events.firstShown();
        this.events.shown();
        if (this.failing) this.events.recovered();
        this.failing = false;
      },
      failed: (error) => {
        this.failing = true;
        this.awaited?.failed(error);
        this.events.failed(`A mesh could not be shown: ${error instanceof Error ? error.message : String(error)}.`);
      },
    });
  }

  get shown(): Shown | undefined {
    return this.store.shown;
  }

  /** Sets the attribute of vertices that is decoded with the bricks that carry it. */
  setAttribute(name: string | undefined): void {
    this.store.setAttribute(name);
  }

  /** Next; one that still waits is skipped. */
  show(frame: Frame): void {
    this.store.show(frame);
  }

  /** Resolves once a picture of it has been drawn, rejects if it cannot be. One at a time. */
  draw(frame: Frame): Promise<void> {
    return new Promise((resolve, reject) => {
      this.awaited = { frame, drawn: resolve, failed: reject };
      this.store.show(frame);
    });
  }

  /** In place of the surface, those that belong to it; none: the surface. */
  showParticles(particles: Particles | undefined): void {
    this.viewer.showParticles(particles);
  }

  /** A picture of the frame has been drawn. True for the frame's first one. */
  frameDrawn(frame: Frame): boolean {
    if (frame === this.awaited?.frame) {
      this.awaited.drawn();
      this.awaited = undefined;
    }
    if (frame === this.lastDrawn) return false;
    const first = !this.lastDrawn;
    this.lastDrawn = frame;
    this.overlay.frameDrawn(frame, this.levels());
    if (first) this.events.firstFrame();
    return true;
  }

  clear(): void {
    this.lastDrawn = undefined;
    this.awaited?.failed(new Error('The frame is not shown any more.'));
    this.awaited = undefined;
    this.store.clear();
    this.viewer.clear();
    this.viewer.showParticles(undefined);
    this.overlay.clear();
  }

  private levels(): number[] {
    const levels = new Array<number>(levelCount).fill(0);
    for (const { decoded } of this.store.shown?.bricks.values() ?? [])
      decoded.levelTriangles.forEach((count, level) => {
        levels[level]! += count;
      });
    return levels;
  }
}
