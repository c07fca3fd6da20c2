// One recording on the screen: its frames as they are wanted, played at a steady pace.
import type { Frame } from '../bricks/frame';
import type { Recording } from '../gen/meniscus/v1/recording_service_pb';
import type { Server } from '../rpc/server';
import { Code, explain, RpcError } from '../rpc/status';
import type { Screen } from '../screen';
import { Backoff } from '../stream/backoff';
import type { WatchState } from '../stream/watch_state';
import type { Playback, Reel } from '../ui/playback';
import { frameText } from '../ui/texts';
import { RecordingFrames } from './recording_frames';
import { sameRecording, type RecordingName } from './recording_name';

/** Some seconds of a large mesh. */
const limits = { ahead: 24, frames: 300, bytes: 192 << 20 };
/** ms from one frame to the next, while they come as fast. */
const pace = 40;

export interface RecordingViewEvents {
  /** The server has it. */
  found(recording: Recording): void;
  state(state: WatchState): void;
  /** Paused at this frame, by its place. */
  restsAt(position: number): void;
}

export class RecordingView {
  private readonly backoff = new Backoff({ first: 500, longest: 8000 });
  private name: RecordingName | undefined;
  private frames: RecordingFrames | undefined;
  private position = 0;
  private drawnAt = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly server: Server,
    private readonly screen: Screen,
    private readonly playback: Playback,
    private readonly events: RecordingViewEvents,
  ) {
    document.addEventListener('visibilitychange', () => {
      if (!document.hidden) this.goOn();
    });
  }

  /** Paused where a place is given, otherwise playing from the beginning. */
  start(name: RecordingName, position?: number): void {
    this.stop();
    this.name = name;
    this.position = position ?? 0;
    this.screen.overlay.setQuality('as recorded');
    this.playback.play(undefined);
    this.playback.setPaused(position !== undefined);
    void this.open(name);
  }

  /** With another token, or once more. */
  restart(): void {
    if (!this.name) return;
    clearTimeout(this.timer);
    if (this.frames) this.frames.show(this.position);
    else void this.open(this.name);
  }

  stop(): void {
    clearTimeout(this.timer);
    this.frames?.stop();
    this.frames = undefined;
    this.name = undefined;
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

  private async open(name: RecordingName): Promise<void> {
    this.events.state({ kind: 'connecting' });
    try {
      const recording = (await this.server.recordings()).find((r) =>
        sameRecording({ session: r.sessionId, number: r.number }, name),
      );
      if (name !== this.name) return;
      if (!recording) throw new RpcError(Code.notFound, 'it may have been deleted');
      this.events.found(recording);
      if (recording.frames === 0n) throw new RpcError(Code.failedPrecondition, 'This recording holds no mesh yet.');
      this.frames = new RecordingFrames(
        Number(recording.frames),
        (position, count, signal) =>
          this.server.readRecording(
            { sessionId: name.session, number: name.number, position: BigInt(position), count: BigInt(count) },
            signal,
          ),
        limits,
        {
          frame: (frame, position) => {
            this.take(frame, position);
          },
          failed: (error) => {
            this.fail(error);
          },
          received: (bytes) => {
            this.screen.overlay.receivedBytes(bytes);
          },
        },
      );
      this.playback.play(this.reel(this.frames));
      this.show(Math.min(this.position, this.frames.length - 1));
    } catch (error) {
      if (name === this.name) this.fail(error);
    }
  }

  private reel(frames: RecordingFrames): Reel {
    return {
      length: frames.length,
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
        else if (this.position > 0 && this.position === frames.length - 1) this.show(0);
        else this.goOn();
      },
      resume: 'Play',
    };
  }

  private show(position: number): void {
    clearTimeout(this.timer);
    this.position = position;
    if (this.playback.paused) {
      this.playback.moveTo(position);
      this.events.restsAt(position);
    }
    this.frames?.show(position);
  }

  private take(frame: Frame, position: number): void {
    this.backoff.reset();
    this.reportState();
    // Its number is known now.
    if (this.playback.paused) this.playback.moveTo(position);
    this.screen.show(frame);
  }

  /** To the next frame, once this one has had its time on the screen. */
  private goOn(): void {
    clearTimeout(this.timer);
    if (!this.frames || this.playback.paused || document.hidden) return;
    if (this.screen.shown?.frame !== this.frames.at(this.position)) return;
    if (this.position + 1 === this.frames.length) {
      this.playback.setPaused(true);
      return;
    }
    this.timer = setTimeout(
      () => {
        this.show(this.position + 1);
      },
      Math.max(0, this.drawnAt + pace - performance.now()),
    );
  }

  private reportState(): void {
    this.events.state({ kind: this.playback.paused ? 'paused' : 'live' });
  }

  private fail(error: unknown): void {
    const code = error instanceof RpcError ? error.code : undefined;
    if (code === Code.unauthenticated || code === Code.permissionDenied) {
      this.events.state({ kind: 'token', reason: explain(error) });
    } else if (code === Code.unavailable || code === Code.deadlineExceeded || code === Code.resourceExhausted) {
      const wait = this.backoff.next();
      this.timer = setTimeout(() => {
        this.restart();
      }, wait);
      this.events.state({ kind: 'waiting', reason: explain(error), retryAt: performance.now() + wait });
    } else {
      this.events.state({ kind: 'refused', reason: reasonOf(error) });
    }
  }
}

function reasonOf(error: unknown): string {
  if (!(error instanceof RpcError)) return explain(error);
  if (error.code === Code.notFound) return `There is no such recording (${error.message}).`;
  if (error.code === Code.unimplemented) return `There are no recordings (${error.message}).`;
  return explain(error);
}
