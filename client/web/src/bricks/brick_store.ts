// From encoded frames to what is shown: decodes only what differs from what is shown, and shows a frame only when all of it is there.
import type { DecodedBrick } from '../decode/decoded_brick';
import type { BrickKey, EncodedBrick, Frame } from './frame';

export type Decode = (brick: EncodedBrick, offsetBits: number) => Promise<DecodedBrick>;

export interface ShownBrick {
  readonly encoded: EncodedBrick;
  readonly decoded: DecodedBrick;
}

/** What is to change on the screen, in one go. */
export interface Shown {
  readonly frame: Frame;
  readonly bricks: ReadonlyMap<BrickKey, ShownBrick>;
}

export interface BrickStoreEvents {
  shown(shown: Shown): void;
  failed(error: unknown): void;
}

export class BrickStore {
  private current: Shown | undefined;
  private waiting: Frame | undefined;
  private decoding = false;
  /** Changes when everything is forgotten. */
  private epoch = 0;

  constructor(
    private readonly decode: Decode,
    private readonly events: BrickStoreEvents,
  ) {}

  get shown(): Shown | undefined {
    return this.current;
  }

  /** The frame is shown next; one that still waits is skipped. */
  show(frame: Frame): void {
    this.waiting = frame;
    if (!this.decoding) void this.work();
  }

  /** Forgets everything: what is being decoded is not shown any more. */
  clear(): void {
    this.current = undefined;
    this.waiting = undefined;
    ++this.epoch;
  }

  private async work(): Promise<void> {
    this.decoding = true;
    while (this.waiting) {
      const frame = this.waiting;
      const { epoch } = this;
      this.waiting = undefined;
      try {
        const shown = { frame, bricks: await this.decodeFrame(frame) };
        if (epoch !== this.epoch) continue;
        this.current = shown;
        this.events.shown(shown);
      } catch (error) {
        if (epoch === this.epoch) this.events.failed(error);
      }
    }
    this.decoding = false;
  }

  private async decodeFrame(frame: Frame): Promise<Map<BrickKey, ShownBrick>> {
    const shown = this.current;
    const sameLattice = shown?.frame.offsetBits === frame.offsetBits;
    const bricks = await Promise.all(
      [...frame.bricks].map(async ([key, encoded]): Promise<[BrickKey, ShownBrick]> => {
        const before = sameLattice ? shown.bricks.get(key) : undefined;
        if (before?.encoded === encoded) return [key, before];
        return [key, { encoded, decoded: await this.decode(encoded, frame.offsetBits) }];
      }),
    );
    return new Map(bricks);
  }
}
