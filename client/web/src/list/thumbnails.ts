// Pictures of the sessions in a list, or of its recordings: one at a time, for what is on the screen.
import { Code, RpcError } from '../rpc/status';
import { ThumbnailSchedule } from './thumbnail_schedule';

/** ms between two pictures of one session. */
export const thumbnailEvery = 10_000;
/** ms for one picture: longer than a server takes to say that there is none. One that says nothing holds up no others. */
export const thumbnailPatience = 30_000;

export class Thumbnails {
  private readonly schedule = new ThumbnailSchedule(thumbnailEvery);
  private call: { readonly session: string; readonly abort: AbortController } | undefined;
  /** From update() to stop(). */
  private running = false;
  /** Whether the server makes none. */
  private none = false;

  /** draw: resolves when the session's picture is drawn, or when there is none yet. */
  constructor(
    private readonly draw: (session: string, signal: AbortSignal) => Promise<void>,
    private readonly now: () => number,
  ) {}

  /** The list that has come, of which some is on the screen. To be called again and again: this is when pictures fall due. */
  update(sessions: readonly { readonly id: string; readonly frames: bigint }[]): void {
    this.running = true;
    this.schedule.update(sessions);
    this.goOn();
  }

  setVisible(session: string, visible: boolean): void {
    this.schedule.setVisible(session, visible);
    this.goOn();
  }

  /** In other colors, say. */
  drawAnew(): void {
    this.schedule.forget();
    this.goOn();
  }

  /** Until the next update(). */
  stop(): void {
    this.running = false;
    if (!this.call) return;
    this.call.abort.abort();
    this.schedule.forget(this.call.session);
    this.call = undefined;
  }

  private goOn(): void {
    if (!this.running || this.call || this.none) return;
    const session = this.schedule.next(this.now());
    if (session === undefined) return;
    const call = { session, abort: new AbortController() };
    this.call = call;
    const late = setTimeout(() => {
      call.abort.abort();
    }, thumbnailPatience);
    void this.draw(session, call.abort.signal)
      .catch((error: unknown) => {
        // After any other error the next picture may come; the list shows the errors that concern it, too.
        if (error instanceof RpcError && error.code === Code.unimplemented) this.none = true;
        if (this.call === call) this.schedule.missed(session);
      })
      .then(() => {
        clearTimeout(late);
        if (this.call !== call) return;
        this.call = undefined;
        this.goOn();
      });
  }
}
