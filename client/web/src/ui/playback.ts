// Pause, step and scrub over the frames that are kept.
import type { Frame } from '../bricks/frame';
import type { History } from '../bricks/history';
import { element } from './page';

export interface PlaybackEvents {
  paused(paused: boolean): void;
  chosen(frame: Frame): void;
}

export class Playback {
  private readonly pauseButton = element('pause', HTMLButtonElement);
  private readonly scrub = element('scrub', HTMLInputElement);
  private isPaused = false;

  constructor(
    private readonly history: History,
    private readonly events: PlaybackEvents,
  ) {
    this.pauseButton.addEventListener('click', () => { this.toggle(); });
    element('back', HTMLButtonElement).addEventListener('click', () => { this.step(-1); });
    element('forward', HTMLButtonElement).addEventListener('click', () => { this.step(1); });
    this.scrub.addEventListener('input', () => { this.choose(Number(this.scrub.value)); });
  }

  get paused(): boolean {
    return this.isPaused;
  }

  toggle(): void {
    this.setPaused(!this.isPaused);
  }

  step(by: number): void {
    this.choose(Number(this.scrub.value) + by);
  }

  clear(): void {
    this.history.clear();
    this.frameAdded();
  }

  /** After a frame has come: the slider stands at the newest. */
  frameAdded(): void {
    this.scrub.max = String(Math.max(0, this.history.frames.length - 1));
    if (!this.isPaused) this.scrub.value = this.scrub.max;
    this.describe();
  }

  setPaused(paused: boolean): void {
    this.isPaused = paused;
    this.pauseButton.textContent = paused ? 'Resume' : 'Pause';
    this.events.paused(paused);
  }

  private choose(at: number): void {
    const frame = this.history.frames[Math.min(Math.max(at, 0), this.history.frames.length - 1)];
    if (!frame) return;
    if (!this.isPaused) this.setPaused(true);
    this.scrub.value = String(this.history.frames.indexOf(frame));
    this.describe();
    this.events.chosen(frame);
  }

  private describe(): void {
    const frame = this.history.frames[Number(this.scrub.value)];
    this.scrub.setAttribute('aria-valuetext', frame ? `frame ${frame.index}` : 'none');
  }
}
