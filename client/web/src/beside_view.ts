// A second session, beside the one that is looked at: its own watch, and no more than its newest frame.
import { BrickStore, type Shown } from './bricks/brick_store';
import type { DecodePool } from './decode/decode_pool';
import type { Server } from './rpc/server';
import { askForFacts } from './scene_facts';
import { watchOptions } from './stream/quality';
import { SessionWatch } from './stream/session_watch';
import type { WatchState } from './stream/watch_state';
import type { WorldBox } from './view/bounds';
import type { Viewer } from './view/viewer';

export interface BesideViewEvents {
  shown(box: WorldBox | undefined): void;
  domain(box: WorldBox | undefined): void;
  /** A remark about the second session; empty: none. */
  says(text: string): void;
}

export class BesideView {
  private readonly store: BrickStore;
  private watch: SessionWatch | undefined;
  private paused = false;
  private attribute: string | undefined;

  constructor(
    private readonly server: Server,
    pool: DecodePool,
    private readonly viewer: Viewer,
    private readonly events: BesideViewEvents,
  ) {
    this.store = new BrickStore((...what) => pool.decode(...what), {
      shown: (shown) => {
        this.viewer.show(shown);
        this.events.shown(this.viewer.box);
      },
      failed: (error) => {
        this.events.says(`A mesh could not be shown: ${error instanceof Error ? error.message : String(error)}.`);
      },
    });
    document.addEventListener('visibilitychange', () => {
      this.setPaused(this.paused);
    });
  }

  get shown(): Shown | undefined {
    return this.store.shown;
  }

  /** That vertices are to carry. */
  setAttribute(name: string | undefined): void {
    if (name === this.attribute) return;
    this.attribute = name;
    this.store.setAttribute(name);
    this.watch?.setOptions(watchOptions('full', 0, name));
  }

  start(session: string): void {
    this.stop();
    const watch = new SessionWatch(this.server, session, watchOptions('full', 0, this.attribute), {
      frame: (frame) => {
        this.store.show(frame);
      },
      state: (state) => {
        this.events.says(stateText(state));
      },
      received: () => undefined,
    });
    this.watch = watch;
    // One that is chosen while the other is paused is to be seen.
    this.setPaused(false);
    watch.start();
    void askForFacts(this.server, { session }).then((facts) => {
      if (watch === this.watch) this.events.domain(facts?.domain);
    });
  }

  /** A hidden tab asks for nothing. */
  setPaused(paused: boolean): void {
    this.paused = paused;
    this.watch?.setPaused(paused || document.hidden);
  }

  /** With another token. */
  restart(): void {
    this.watch?.start();
  }

  stop(): void {
    this.watch?.stop();
    this.watch = undefined;
    this.store.clear();
    this.viewer.clear();
  }
}

function stateText(state: WatchState): string {
  switch (state.kind) {
    case 'connecting':
      return 'Connecting…';
    case 'connected':
      return 'Connected. No frame has come yet.';
    case 'waiting':
    case 'absent':
    case 'token':
    case 'refused':
      return state.reason;
    case 'draining':
      return 'The server shuts down.';
    case 'ended':
      return 'The session has ended.';
    case 'live':
    case 'paused':
      return '';
  }
}
