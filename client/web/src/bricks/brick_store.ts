// From encoded frames to what is shown: decodes only what differs from what is shown, and shows a frame only when all of it is there.
import type { DecodedBrick } from '../decode/decoded_brick';
import type { BrickKey, EncodedBrick, Frame } from './frame';
import { joinNormals } from './joined_normals';

/** attribute: of those that the brick carries, the one that is decoded, too. */
export type Decode = (brick: EncodedBrick, offsetBits: number, attribute?: string) => Promise<DecodedBrick>;

export interface ShownBrick {
  readonly encoded: EncodedBrick;
  readonly decoded: DecodedBrick;
}

/** A frame and its bricks, which change on the screen in one go. */
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
  private decoding: Frame | undefined;
  private attribute: string | undefined;
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

  /** The one that bricks are decoded with, where they carry it; also those that are shown. */
  setAttribute(name: string | undefined): void {
    if (name === this.attribute) return;
    this.attribute = name;
    const frame = this.waiting ?? this.decoding ?? this.current?.frame;
    if (frame?.attributes.some((attribute) => attribute.carried && attribute.name === name)) this.show(frame);
  }

  /** Forgets everything: what is being decoded is not shown any more. */
  clear(): void {
    this.current = undefined;
    this.waiting = undefined;
    ++this.epoch;
  }

  private async work(): Promise<void> {
    while (this.waiting) {
      const frame = this.waiting;
      this.decoding = frame;
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
    this.decoding = undefined;
  }

  private async decodeFrame(frame: Frame): Promise<ReadonlyMap<BrickKey, ShownBrick>> {
    const shown = this.current;
    const sameLattice = shown?.frame.offsetBits === frame.offsetBits;
    const { attribute } = this;
    const bricks = await Promise.all(
      [...frame.bricks].map(async ([key, encoded]): Promise<[BrickKey, ShownBrick]> => {
        const before = sameLattice ? shown.bricks.get(key) : undefined;
        const has = before?.decoded.attribute?.name === attribute;
        const wanted = attribute !== undefined && encoded.attributes.some(({ name }) => name === attribute);
        if (before?.encoded === encoded && (has || !wanted)) return [key, before];
        return [key, { encoded, decoded: await this.decode(encoded, frame.offsetBits, attribute) }];
      }),
    );
    return joinNormals(new Map(bricks), shown?.bricks ?? new Map<BrickKey, ShownBrick>(), frame.offsetBits);
  }
}
