// One line that says what is wrong and what happens next; a countdown while waiting.
import type { WatchState } from '../stream/watch_state';
import { element } from './page';

export class Banner {
  private readonly line = element('banner', HTMLElement);
  private ticking: ReturnType<typeof setInterval> | undefined;

  say(text: string): void {
    clearInterval(this.ticking);
    if (this.line.textContent !== text) this.line.textContent = text;
    this.line.hidden = text === '';
  }

  watching(state: WatchState): void {
    switch (state.kind) {
      case 'waiting':
        this.countDown(state.reason, state.retryAt);
        return;
      case 'draining':
        this.say(`The server shuts down within ${Math.ceil(state.seconds)} s. The viewer reconnects by itself.`);
        return;
      case 'ended':
        this.say('The session has ended. What came last stays on the screen; should its simulator return, so does the picture.');
        return;
      case 'refused':
      case 'token':
        this.say(state.reason);
        return;
      case 'connecting':
      case 'live':
      case 'paused':
        this.say('');
    }
  }

  countDown(reason: string, retryAt: number): void {
    const tick = (): void => {
      const seconds = Math.max(0, Math.ceil((retryAt - performance.now()) / 1000));
      this.line.textContent = `${reason} Trying again in ${seconds} s.`;
    };
    this.say(reason);
    tick();
    this.ticking = setInterval(tick, 250);
  }
}
