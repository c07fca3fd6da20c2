// One line that says what is wrong and what happens next; a countdown while waiting.
import type { WatchState } from '../stream/watch_state';
import { element } from './page';
import { clockText } from './texts';

export class Banner {
  private readonly banner = element('banner', HTMLElement);
  /** Read aloud when it changes. */
  private readonly text = element('banner-text', HTMLElement);
  /** Changes too often to be read aloud. */
  private readonly countdown = element('banner-countdown', HTMLElement);
  private readonly askToken = element('ask-token', HTMLButtonElement);
  private ticking: ReturnType<typeof setInterval> | undefined;

  say(text: string): void {
    clearInterval(this.ticking);
    if (this.text.textContent !== text) this.text.textContent = text;
    this.countdown.textContent = '';
    this.askToken.hidden = true;
    this.banner.hidden = text === '';
  }

  watching(state: WatchState): void {
    switch (state.kind) {
      case 'connecting':
        // The text before an attempt holds until it has succeeded.
        clearInterval(this.ticking);
        if (this.countdown.textContent !== '') this.countdown.textContent = ' now.';
        return;
      case 'waiting':
      case 'absent':
        this.countDown(state.reason, state.retryAt);
        return;
      case 'draining':
        this.say(`The server shuts down within ${Math.ceil(state.seconds)} s. The viewer connects again by itself.`);
        return;
      case 'ended':
        this.say(
          `The session has ended at ${clockText(state.at)}${state.reason && `: ${state.reason}`}. What came last stays on the screen; should its simulator return, so does the picture.`,
        );
        return;
      case 'token':
        this.tokenNeeded(state.reason);
        return;
      case 'refused':
        this.say(state.reason);
        return;
      case 'connected':
      case 'live':
      case 'paused':
        this.say('');
    }
  }

  /** With a button that asks for one. */
  tokenNeeded(reason: string): void {
    this.say(reason);
    this.askToken.hidden = false;
  }

  /** retryAt: on the page's clock, ms. */
  countDown(reason: string, retryAt: number): void {
    this.say(`${reason} Trying again`);
    const tick = (): void => {
      const seconds = Math.max(0, Math.ceil((retryAt - performance.now()) / 1000));
      this.countdown.textContent = ` in ${seconds} s.`;
    };
    tick();
    this.ticking = setInterval(tick, 250);
  }
}
