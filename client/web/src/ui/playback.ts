// Pause, step and scrub: over the frames that are kept, or over a recording.
import { element } from './page';

/** A sequence of frames that is played, by place. */
export interface Reel {
  /** The place behind the last frame. */
  readonly length: number;
  /** The place of the first frame that is there. Not given: 0. */
  readonly first?: number;
  /** Whether it plays by itself, at a speed, and may begin again at its end. */
  readonly plays?: boolean;
  /** Frame and time, where they are known. */
  describe(at: number): string;
  /** To be shown; paused already. */
  choose(at: number): void;
  paused(paused: boolean): void;
  /** On the button, while it is paused. */
  readonly resume: string;
}

export class Playback {
  private readonly pauseButton = element('pause', HTMLButtonElement);
  private readonly pauseIcon = this.pauseButton.querySelector('use')!;
  private readonly scrub = element('scrub', HTMLInputElement);
  /** The frame, in words, beside the slider. */
  private readonly text = element('at', HTMLElement);
  private readonly speedSelect = element('speed', HTMLSelectElement);
  private readonly loopButton = element('loop', HTMLButtonElement);
  private reel: Reel | undefined;
  private isPaused = false;

  /** changed: the speed, or whether it begins again. */
  constructor(private readonly changed: () => void) {
    this.speedSelect.addEventListener('change', () => {
      this.changed();
    });
    this.loopButton.addEventListener('click', () => {
      this.setLoops(!this.loops);
      this.changed();
    });
    this.pauseButton.addEventListener('click', () => {
      this.toggle();
    });
    element('back', HTMLButtonElement).addEventListener('click', () => {
      this.step(-1);
    });
    element('forward', HTMLButtonElement).addEventListener('click', () => {
      this.step(1);
    });
    this.scrub.addEventListener('input', () => {
      this.choose(Number(this.scrub.value));
    });
  }

  get paused(): boolean {
    return this.isPaused;
  }

  /** The place of the slider. */
  get at(): number {
    return Number(this.scrub.value);
  }

  /** Frames that can be chosen. */
  get length(): number {
    return this.reel?.length ?? 0;
  }

  /** Of 1: as it was made. */
  get speed(): number {
    return Number(this.speedSelect.value);
  }

  /** Whether the first frame follows the last one. */
  get loops(): boolean {
    return this.loopButton.getAttribute('aria-pressed') === 'true';
  }

  /** A speed that is not offered is 1. */
  setSpeed(speed: number): void {
    this.speedSelect.value = String(speed);
    if (this.speedSelect.selectedIndex < 0) this.speedSelect.value = '1';
  }

  setLoops(loops: boolean): void {
    this.loopButton.setAttribute('aria-pressed', String(loops));
  }

  /** In place of the one before. */
  play(reel: Reel | undefined): void {
    this.reel = reel;
    element('pace', HTMLElement).hidden = reel?.plays !== true;
    this.label();
    this.moveTo(this.first);
  }

  /** The reel has other ends. */
  grown(): void {
    this.moveTo(Math.max(this.first, this.at));
  }

  toggle(): void {
    this.setPaused(!this.isPaused);
  }

  step(by: number): void {
    this.choose(this.at + by);
  }

  /** The slider follows what is shown. */
  moveTo(at: number): void {
    this.scrub.min = String(this.first);
    this.scrub.max = String(Math.max(this.first, this.length - 1));
    this.scrub.value = String(at);
    const described = this.reel && at < this.reel.length ? this.reel.describe(at) : '';
    this.scrub.setAttribute('aria-valuetext', described === '' ? 'none' : described);
    this.text.textContent = described;
  }

  setPaused(paused: boolean): void {
    this.isPaused = paused;
    this.label();
    this.reel?.paused(paused);
  }

  private get first(): number {
    return this.reel?.first ?? 0;
  }

  private label(): void {
    element('pause-text', HTMLElement).textContent = this.isPaused ? (this.reel?.resume ?? 'Resume') : 'Pause';
    this.pauseIcon.setAttribute('href', this.isPaused ? '#icon-play' : '#icon-pause');
  }

  private choose(at: number): void {
    if (!this.reel || this.length === 0) return;
    if (!this.isPaused) this.setPaused(true);
    this.moveTo(Math.min(Math.max(at, this.first), this.length - 1));
    this.reel.choose(this.at);
  }
}
