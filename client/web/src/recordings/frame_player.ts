// Frames on the screen as they are wanted, played at a steady pace: of a recording, or of a publication that may grow.
import type { Frame } from '../bricks/frame';
import type { Screen } from '../screen';
import type { Backoff } from '../stream/backoff';
import type { Playback, Reel } from '../ui/playback';
import { frameText } from '../ui/texts';
import { RecordingFrames, type ReadFrames } from './recording_frames';

/** Some seconds of a large mesh. */
const limits = { ahead: 24, frames: 300, bytes: 192 << 20 };

/** The frames that are played. Places count from 0. */
export interface Film {
  /** The place behind the last frame, when it is opened. */
  readonly length: number;
  /** The place of the first frame that is there. */
  first(): number;
  /** ms from this frame to the next, at the speed 1. */
  pace(position: number): number;
  /**
   * The place to go on to from a frame after which more are expected: the next one, or a later one to catch up. None:
   * the film ends. paces: how often its time on the screen has passed while it was fetched and drawn.
   */
  after(position: number, paces: number): number | undefined;
  readonly read: ReadFrames;
}

export interface FramePlayerEvents {
  state(state: { readonly kind: 'live' | 'paused' }): void;
  /** Paused at this frame, by its place. */
  restsAt(position: number): void;
}

export class FramePlayer {
  private film: Film | undefined;
  private frames: RecordingFrames | undefined;
  private position = 0;
  private askedAt = 0;
  private drawnAt = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;

  /**
   * backoff: begins anew with each frame. failed: a frame that is wanted could not be fetched; nothing is tried until
   * again().
   */
  constructor(
    private readonly screen: Screen,
    private readonly playback: Playback,
    private readonly backoff: Backoff,
    private readonly events: FramePlayerEvents,
    private readonly failed: (error: unknown) => void,
  ) {
    document.addEventListener('visibilitychange', () => {
      if (!document.hidden) this.goOn();
    });
  }

  get isOpen(): boolean {
    return this.film !== undefined;
  }

  /** Whether no frame is there yet beyond that which is shown. */
  get isAtEnd(): boolean {
    return this.position + 1 >= (this.frames?.length ?? 0);
  }

  /** Shows the frame at a place, the nearest that there is. */
  open(film: Film, position: number): void {
    this.stop();
    this.film = film;
    this.frames = new RecordingFrames(film.length, film.read, limits, {
      frame: (frame, at) => {
        this.take(frame, at);
      },
      failed: this.failed,
      received: (bytes) => {
        this.screen.overlay.receivedBytes(bytes);
      },
    });
    this.playback.play(this.reel(film, this.frames));
    this.show(Math.max(film.first(), Math.min(position, film.length - 1)));
  }

  /** Once more; a frame that has left is that after it. */
  again(): void {
    if (this.film) this.show(Math.max(this.position, this.film.first()));
  }

  /** More frames have come. length: the place behind the last one. */
  grow(length: number): void {
    this.frames?.grow(length);
    this.playback.grown();
    this.goOn();
  }

  stop(): void {
    clearTimeout(this.timer);
    this.frames?.stop();
    this.frames = undefined;
    this.film = undefined;
  }

  /** The frame's first picture has been drawn: the next one is due. */
  frameDrawn(frame: Frame): void {
    if (!this.frames) return;
    this.drawnAt = performance.now();
    // While it is paused the slider is a person's.
    if (!this.playback.paused && frame === this.frames.at(this.position)) this.playback.moveTo(this.position);
    if (!this.playback.paused) this.screen.overlay.framePlayed(frame);
    this.goOn();
  }

  private reel(film: Film, frames: RecordingFrames): Reel {
    return {
      get length() {
        return frames.length;
      },
      get first() {
        return film.first();
      },
      describe: (at) => {
        const frame = frames.at(at);
        return frame ? frameText(frame) : 'loading';
      },
      choose: (at) => {
        this.show(at);
      },
      paused: (paused) => {
        this.reportState();
        // That one is drawn yet.
        if (paused) this.playback.moveTo(this.position);
        if (paused) this.events.restsAt(this.position);
        else if (this.position > film.first() && this.isLast(film)) this.show(film.first());
        else this.goOn();
      },
      resume: 'Play',
      plays: true,
    };
  }

  /** Whether no frame follows, now or later. */
  private isLast(film: Film): boolean {
    return this.isAtEnd && film.after(this.position, 0) === undefined;
  }

  private show(position: number): void {
    clearTimeout(this.timer);
    this.position = position;
    this.askedAt = performance.now();
    if (this.playback.paused) {
      this.playback.moveTo(position);
      this.events.restsAt(position);
    }
    this.frames?.show(position);
  }

  private take(frame: Frame, position: number): void {
    this.reportState();
    // Its number is known now.
    if (this.playback.paused) this.playback.moveTo(position);
    this.screen.show(frame);
  }

  /** To the next frame, once this one has had its time on the screen. */
  private goOn(): void {
    clearTimeout(this.timer);
    const { film, frames } = this;
    if (!film || !frames || this.playback.paused || document.hidden) return;
    if (this.screen.shown?.frame !== frames.at(this.position)) return;
    const pace = film.pace(this.position) / this.playback.speed;
    let next = film.after(this.position, (this.drawnAt - this.askedAt) / pace);
    if (next === undefined && this.position + 1 < frames.length) next = this.position + 1;
    if (next === undefined) {
      if (this.playback.loops) next = film.first();
      else {
        this.playback.setPaused(true);
        return;
      }
    }
    // A film that grows calls again.
    if (next >= frames.length) return;
    const to = next;
    this.timer = setTimeout(
      () => {
        this.show(to);
      },
      Math.max(0, this.drawnAt + pace - performance.now()),
    );
  }

  private reportState(): void {
    this.backoff.reset();
    this.events.state({ kind: this.playback.paused ? 'paused' : 'live' });
  }
}
