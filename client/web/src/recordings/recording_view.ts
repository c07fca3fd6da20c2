// One recording on the screen: its frames as they are wanted, played at a steady pace.
import type { Frame } from '../bricks/frame';
import type { Recording } from '../gen/meniscus/v1/recording_service_pb';
import type { Server } from '../rpc/server';
import { Code, explain, RpcError } from '../rpc/status';
import type { Screen } from '../screen';
import { Backoff } from '../stream/backoff';
import type { WatchState } from '../stream/watch_state';
import type { Playback } from '../ui/playback';
import { FramePlayer } from './frame_player';
import { recordedFrames } from './recorded_frames';
import { sameRecording, type RecordingName } from './recording_name';

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
  private readonly player: FramePlayer;
  private name: RecordingName | undefined;
  private position = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly server: Server,
    private readonly screen: Screen,
    private readonly playback: Playback,
    private readonly events: RecordingViewEvents,
  ) {
    this.player = new FramePlayer(screen, playback, this.backoff, events, (error) => {
      this.fail(error);
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
    if (this.player.isOpen) this.player.again();
    else void this.open(this.name);
  }

  stop(): void {
    clearTimeout(this.timer);
    this.player.stop();
    this.name = undefined;
  }

  /** The frame's first picture has been drawn: the next one is due. */
  frameDrawn(frame: Frame): void {
    this.player.frameDrawn(frame);
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
      this.player.open(
        {
          length: Number(recording.frames),
          first: () => 0,
          pace: () => pace,
          after: () => undefined,
          read: (position, count, signal) =>
            recordedFrames(
              this.server.readRecording(
                { sessionId: name.session, number: name.number, position: BigInt(position), count: BigInt(count) },
                signal,
              ),
            ),
        },
        this.position,
      );
    } catch (error) {
      if (name === this.name) this.fail(error);
    }
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
