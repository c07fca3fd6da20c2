// The name of the session or the recording, and whether it is live: in the page's head and in the tab's title.
import type { Recording } from '../gen/meniscus/v1/recording_service_pb';
import type { Session } from '../gen/meniscus/v1/session_service_pb';
import { givenName, shortId } from '../list/session_name';
import { recordingNameText, type RecordingName } from '../recordings/recording_name';
import type { Server } from '../rpc/server';
import type { WatchState } from '../stream/watch_state';
import { livenessOf, type Liveness } from './liveness';
import { element } from './page';

/** ms */
const askEvery = 2000;

export class Heading {
  private readonly title = element('title', HTMLElement);
  private readonly badge = element('liveness', HTMLElement);
  private session: string | undefined;
  private watch: WatchState = { kind: 'connecting' };
  private uploading: boolean | undefined;
  private restsSince: number | undefined;
  private timer: ReturnType<typeof setTimeout> | undefined;

  /** live: when it begins to be streamed, or ends. */
  constructor(
    private readonly server: Server,
    private readonly live: (live: boolean) => void,
  ) {
    document.addEventListener('visibilitychange', () => {
      this.ask();
    });
  }

  /** The list. */
  showNothing(): void {
    this.clear();
    this.say('', '');
  }

  showSession(session: string): void {
    this.clear();
    this.session = session;
    this.say(session, shortId(session));
    this.ask();
  }

  showRecording(name: RecordingName): void {
    this.clear();
    this.say(`Recording ${recordingNameText(name)}`, `Recording of ${shortId(name.session)}`);
  }

  /** name: for people; empty: it has none. */
  showPublication(name: string): void {
    this.clear();
    const text = name === '' ? 'Publication' : name;
    this.say(text, text);
  }

  /** Takes the description of the recording that is shown. */
  described(recording: Recording): void {
    const name = givenName(recording);
    if (name !== '') this.say(`Recording ${recording.number} of ${name}`, `Recording of ${name}`);
  }

  /** Takes the state of the watch of the session that is shown. */
  watching(state: WatchState): void {
    if (this.session === undefined) return;
    this.watch = state;
    this.updateLiveness();
    // It streams, or does so again: that is not to be learned only when its time has come.
    if (state.kind === 'live' && this.uploading !== true) this.ask();
  }

  private clear(): void {
    clearTimeout(this.timer);
    this.session = undefined;
    this.watch = { kind: 'connecting' };
    this.uploading = undefined;
    this.restsSince = undefined;
    this.showLiveness({ text: '', live: false });
  }

  private ask(): void {
    clearTimeout(this.timer);
    const { session } = this;
    if (session === undefined || document.hidden) return;
    void this.server
      .session(session)
      .then((answer) => {
        if (session === this.session) this.take(answer);
      })
      // The watch reports errors.
      .catch(() => undefined)
      .then(() => {
        if (session !== this.session) return;
        // Another question may have been under way.
        clearTimeout(this.timer);
        this.timer = setTimeout(() => {
          this.ask();
        }, askEvery);
      });
  }

  private take(session: Session): void {
    const name = givenName(session);
    if (name !== '') this.say(name, name);
    if (session.uploading) this.restsSince = undefined;
    else if (this.uploading === true) this.restsSince = Date.now();
    this.uploading = session.uploading;
    this.updateLiveness();
  }

  private updateLiveness(): void {
    const liveness = livenessOf(this.watch, this.uploading, this.restsSince);
    if (liveness) this.showLiveness(liveness);
  }

  private showLiveness({ text, live }: Liveness): void {
    if (this.badge.textContent !== text) this.badge.textContent = text;
    this.badge.classList.toggle('live', live);
    this.live(live);
  }

  /** inTab: empty where nothing is looked at. */
  private say(inPage: string, inTab: string): void {
    if (this.title.textContent !== inPage) this.title.textContent = inPage;
    document.title = inTab === '' ? 'Meniscus' : `${inTab} – Meniscus`;
  }
}
