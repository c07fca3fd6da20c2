// Watches one session until it is stopped: connects, reconnects, changes its options, pauses.
import { FrameReceiver } from '../bricks/frame_receiver';
import type { Frame } from '../bricks/frame';
import { Code, explain, RpcError } from '../rpc/status';
import type { Received } from '../rpc/call';
import type { WatchRequestInit } from '../rpc/server';
import type { WatchResponse } from '../gen/meniscus/v1/surface_service_pb';
import { Backoff, reconnecting, resting } from './backoff';
import { FrameOrder } from './frame_order';
import type { SessionEnd, WatchState } from './watch_state';

export type WatchOptions = Omit<WatchRequestInit, 'sessionId'>;

export interface WatchServer {
  watch(
    request: WatchOptions & { sessionId: string },
    signal: AbortSignal,
    opened: () => void,
    ended: (reason: string) => void,
  ): AsyncIterable<Received<WatchResponse>>;
}

export interface WatchEvents {
  frame(frame: Frame): void;
  state(state: WatchState): void;
  /** The size of every message, as it comes. */
  received(bytes: number): void;
}

/** Tried again, with what the viewer shows kept: the server may come back, its simulator make the session again, on another GPU perhaps. */
const passing: ReadonlySet<Code> = new Set([
  Code.unavailable,
  Code.resourceExhausted,
  Code.deadlineExceeded,
  Code.internal,
  Code.aborted,
  Code.unknown,
]);

export class SessionWatch {
  /** Whether the session has refused a coarser surface: one that was made elsewhere has none. */
  private finestOnly = false;
  private readonly backoff = new Backoff(reconnecting);
  private readonly longBackoff = new Backoff(resting);
  private readonly order = new FrameOrder();
  private call: AbortController | undefined;
  private retry: ReturnType<typeof setTimeout> | undefined;
  private options: WatchOptions;
  private paused = false;
  /** Whether nothing is tried any more. */
  private over = false;
  /** The session's end, once it has ended; its simulator may make it again. */
  private sessionEnd: SessionEnd | undefined;
  /** The kind of the last state that was reported. */
  private reported: WatchState['kind'] | undefined;

  constructor(
    private readonly server: WatchServer,
    private readonly sessionId: string,
    options: WatchOptions,
    private readonly events: WatchEvents,
  ) {
    this.options = options;
  }

  start(): void {
    this.stop();
    this.over = false;
    if (this.paused) {
      // An end stays one, also while a frame before it is looked at.
      if (!this.reportEnd()) this.report({ kind: 'paused' });
      return;
    }
    const call = new AbortController();
    this.call = call;
    if (this.sessionEnd === undefined) this.report({ kind: 'connecting' });
    void this.run(call.signal);
  }

  /** Takes effect at once: the meshes that follow have these options. */
  setOptions(options: WatchOptions): void {
    this.options = options;
    if (this.call) this.start();
  }

  setPaused(paused: boolean): void {
    if (paused === this.paused) return;
    this.paused = paused;
    if (!this.over) this.start();
  }

  /** Nothing is reported any more. */
  stop(): void {
    clearTimeout(this.retry);
    this.retry = undefined;
    this.call?.abort();
    this.call = undefined;
  }

  private request(): WatchOptions & { sessionId: string } {
    const request = { ...this.options, sessionId: this.sessionId };
    if (this.finestOnly) delete request.maxLevel;
    return request;
  }

  private async run(signal: AbortSignal): Promise<void> {
    const receiver = new FrameReceiver();
    const opened = (): void => {
      if (!signal.aborted && (this.sessionEnd === undefined || this.reported !== 'ended'))
        this.report({ kind: 'connected' });
    };
    try {
      let reason = '';
      const ended = (words: string): void => {
        reason = words;
      };
      for await (const { message, bytes } of this.server.watch(this.request(), signal, opened, ended)) {
        if (signal.aborted) return;
        this.take(receiver, message, bytes);
      }
      if (signal.aborted) return;
      this.sessionEnd = { at: Date.now(), reason };
      this.reportEnd();
      this.scheduleRetry();
    } catch (error) {
      if (!signal.aborted) this.fail(error);
    }
  }

  private take(receiver: FrameReceiver, message: WatchResponse, bytes: number): void {
    this.events.received(bytes);
    if (message.message.case === 'draining') {
      this.report({ kind: 'draining', seconds: message.message.value.seconds });
      return;
    }
    if (message.message.case === 'meshBegin' && !receiver.begun) {
      this.sessionEnd = undefined;
      this.report({ kind: 'live' });
    }
    const frame = receiver.take(message, bytes, performance.now());
    if (!frame) return;
    this.backoff.reset();
    this.longBackoff.reset();
    if (this.order.admits(frame)) this.events.frame(frame);
  }

  private fail(error: unknown): void {
    const reason = explain(error);
    if (!(error instanceof RpcError))
      this.end({
        kind: 'refused',
        reason: `The server sent something that this page does not understand: ${reason}. Load the page again.`,
      });
    else if (error.code === Code.unauthenticated || error.code === Code.permissionDenied)
      this.end({ kind: 'token', reason });
    else if (error.code === Code.notFound && this.reportEnd()) this.scheduleRetry();
    else if (error.code === Code.notFound) this.report({ kind: 'absent', retryAt: this.scheduleRetry(), reason });
    else if (passing.has(error.code)) this.report({ kind: 'waiting', retryAt: this.scheduleRetry(), reason });
    else if (error.code === Code.failedPrecondition && this.request().maxLevel !== undefined) {
      this.finestOnly = true;
      this.start();
    } else this.end({ kind: 'refused', reason });
  }

  /** When: on the page's clock, ms. */
  private scheduleRetry(): number {
    this.call = undefined;
    const wait = (this.sessionEnd !== undefined ? this.longBackoff : this.backoff).next();
    this.retry = setTimeout(() => {
      this.start();
    }, wait);
    return performance.now() + wait;
  }

  private report(state: WatchState): void {
    this.reported = state.kind;
    this.events.state(state);
  }

  /** Reports the end, unless that was the last report; false: the session has not ended. After a failed try the end is reported again. */
  private reportEnd(): boolean {
    if (this.sessionEnd === undefined) return false;
    if (this.reported !== 'ended') this.report({ kind: 'ended', ...this.sessionEnd });
    return true;
  }

  private end(state: WatchState): void {
    this.call = undefined;
    this.over = true;
    this.report(state);
  }
}
