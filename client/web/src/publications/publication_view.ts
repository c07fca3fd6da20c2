// One publication on the screen: played at its pace, and, while it grows, close behind its newest frame.
import type { Frame } from '../bricks/frame';
import { ProtocolError } from '../bricks/protocol_error';
import { FramePlayer, type Film } from '../recordings/frame_player';
import type { Screen } from '../screen';
import { Backoff, reconnecting } from '../stream/backoff';
import type { WatchState } from '../stream/watch_state';
import type { Playback } from '../ui/playback';
import { segmentAt, type Manifest } from './manifest';
import { Publication } from './publication';
import { FileMissing, FileUnavailable, TokenNeeded, type PublicationFiles } from './publication_files';

/** ms between two looks at the manifest of a publication that grows. */
const lookEvery = 500;
/** Seconds of unshown frames of a growing publication, beyond which the player leaves some out. */
const furthestBehind = 3;
/** Of a segment that says none, ms for a frame. */
const standardPace = 40;

export interface PublicationViewEvents {
  found(manifest: Manifest): void;
  state(state: WatchState): void;
  /** Paused at this frame, by its place. */
  restsAt(position: number): void;
}

export class PublicationView {
  private readonly backoff = new Backoff(reconnecting);
  private readonly player: FramePlayer;
  private files: PublicationFiles | undefined;
  private publication: Publication | undefined;
  private position: number | undefined;
  private ended = new AbortController();
  private timer: ReturnType<typeof setTimeout> | undefined;
  private retry: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly screen: Screen,
    private readonly playback: Playback,
    private readonly events: PublicationViewEvents,
  ) {
    this.player = new FramePlayer(screen, playback, this.backoff, events, (error) => {
      this.fail(error);
    });
  }

  /** Paused where a place is given, otherwise playing: from the beginning, or, where it grows, its newest segment. */
  start(files: PublicationFiles, position?: number): void {
    this.stop();
    this.files = files;
    this.position = position;
    this.screen.overlay.setQuality('as published');
    this.playback.play(undefined);
    this.playback.setPaused(position !== undefined);
    void this.open();
  }

  stop(): void {
    clearTimeout(this.timer);
    clearTimeout(this.retry);
    this.ended.abort();
    this.ended = new AbortController();
    this.player.stop();
    this.files = undefined;
    this.publication = undefined;
  }

  /** The frame's first picture has been drawn: the next one is due. */
  frameDrawn(frame: Frame): void {
    this.player.frameDrawn(frame);
  }

  /** All frames that there are, each once. */
  allFrames(signal: AbortSignal): AsyncIterable<Frame> {
    const { publication } = this;
    if (!publication) throw new Error('There is no frame yet.');
    const { first, end } = publication.manifest;
    return publication.frames(first, end - first, signal);
  }

  private async open(): Promise<void> {
    const { files, ended } = this;
    if (!files) return;
    this.events.state({ kind: 'connecting' });
    try {
      const publication = await Publication.open(files, ended.signal);
      if (ended.signal.aborted) return;
      this.publication = publication;
      this.events.found(publication.manifest);
      this.show(publication);
      this.lookAgain();
    } catch (error) {
      if (!ended.signal.aborted) this.fail(error);
    }
  }

  /** Once it has a frame. */
  private show(publication: Publication): void {
    const { manifest } = publication;
    if (manifest.end > manifest.first) {
      const newest = manifest.segments.at(-1)!.first;
      this.player.open(filmOf(publication), this.position ?? (manifest.live ? newest : manifest.first));
    } else if (manifest.live) this.events.state({ kind: 'connected' });
    else this.events.state({ kind: 'refused', reason: 'This publication has no frames.' });
  }

  private lookAgain(): void {
    clearTimeout(this.timer);
    if (!this.publication?.manifest.live) return;
    this.timer = setTimeout(() => void this.look(), lookEvery);
  }

  private async look(): Promise<void> {
    const { publication, ended } = this;
    if (!publication) return;
    try {
      if (!document.hidden) await publication.refresh(ended.signal);
      if (ended.signal.aborted) return;
      if (!this.player.isOpen) this.show(publication);
      else this.player.grow(publication.manifest.end);
    } catch (error) {
      if (ended.signal.aborted) return;
      // The frames that are there play on.
      if (this.player.isAtEnd || error instanceof ProtocolError || error instanceof TokenNeeded) {
        this.fail(error);
        return;
      }
    }
    this.lookAgain();
  }

  private fail(error: unknown): void {
    clearTimeout(this.retry);
    const reason = error instanceof Error ? error.message : String(error);
    if (error instanceof FileUnavailable || (error instanceof FileMissing && this.publication)) {
      const wait = this.backoff.next();
      this.retry = setTimeout(() => void this.again(), wait);
      this.events.state({ kind: 'waiting', reason, retryAt: performance.now() + wait });
    } else if (error instanceof TokenNeeded) {
      clearTimeout(this.timer);
      this.events.state({ kind: 'token', reason });
    } else {
      clearTimeout(this.timer);
      const sentence = error instanceof ProtocolError ? `The publication cannot be read: ${reason}.` : reason;
      this.events.state({ kind: 'refused', reason: sentence });
    }
  }

  /** A frame that is not there any more may have left: the manifest says so. */
  private async again(): Promise<void> {
    const { publication, ended } = this;
    if (!publication || !this.player.isOpen) {
      await this.open();
      return;
    }
    try {
      await publication.refresh(ended.signal);
      if (ended.signal.aborted) return;
      this.player.grow(publication.manifest.end);
      this.player.again();
      this.lookAgain();
    } catch (error) {
      if (!ended.signal.aborted) this.fail(error);
    }
  }
}

function filmOf(publication: Publication): Film {
  return {
    length: publication.manifest.end,
    first: () => publication.manifest.first,
    pace: (position) => {
      const segment = segmentAt(publication.manifest, position);
      return segment && segment.seconds > 0 ? (1000 * segment.seconds) / segment.frames : standardPace;
    },
    after: (position, paces) => (publication.manifest.live ? next(publication.manifest, position, paces) : undefined),
    read: (position, count, signal) => publication.frames(position, count, signal),
  };
}

/**
 * The frame after this one of a publication that grows, which is to stay close behind its newest. paces: how many
 * frames' times have passed while this one was fetched and drawn; as many are left out. Its newest segment's first where
 * too much is still unshown.
 */
export function next({ segments }: Pick<Manifest, 'segments'>, position: number, paces: number): number {
  let seconds = 0;
  for (let i = segments.length - 1; i >= 0; --i) {
    const { first, frames, seconds: all } = segments[i]!;
    if (first <= position) {
      seconds += (all * Math.max(0, first + frames - 1 - position)) / frames;
      break;
    }
    seconds += all;
  }
  const newest = segments.at(-1)!;
  if (seconds > furthestBehind) return newest.first;
  return Math.max(position + 1, Math.min(position + 1 + Math.floor(paces), newest.first + newest.frames - 1));
}
