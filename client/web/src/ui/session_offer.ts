// In place of a session that is not there: those that are.
import { givenName, shortId } from '../list/session_name';
import { inOrder } from '../list/session_order';
import type { Server } from '../rpc/server';
import { element } from './page';

/** The others are in the list. */
const most = 5;

export class SessionOffer {
  private readonly box = element('session-offer', HTMLElement);
  private readonly list = element('offered-sessions', HTMLUListElement);
  private asked: symbol | undefined;

  /** chosen: none for the list of all. */
  constructor(
    private readonly server: Server,
    private readonly chosen: (session: string | undefined) => void,
  ) {
    element('all-sessions', HTMLButtonElement).addEventListener('click', () => {
      this.chosen(undefined);
    });
  }

  /** Until withdraw(). */
  async offer(): Promise<void> {
    const asked = (this.asked = Symbol('asked'));
    // The watch reports errors.
    const sessions = await this.server.sessions().catch(() => []);
    if (asked !== this.asked) return;
    const offered = inOrder(sessions).slice(0, most);
    const before = [...this.list.querySelectorAll('button')].map(({ dataset }) => dataset.session);
    // A button that is about to be pressed stays.
    if (offered.map(({ id }) => id).join() !== before.join())
      this.list.replaceChildren(
        ...offered.map((session) => this.entry(session.id, givenName(session), session.uploading)),
      );
    const none = sessions.length === 0;
    element('session-offer-heading', HTMLElement).textContent = none
      ? 'There is no session on this server yet.'
      : 'Sessions that are there';
    this.box.hidden = false;
  }

  withdraw(): void {
    this.asked = undefined;
    this.box.hidden = true;
  }

  private entry(id: string, name: string, live: boolean): HTMLElement {
    const button = document.createElement('button');
    button.type = 'button';
    button.dataset.session = id;
    const title = document.createElement('bdi');
    title.textContent = name === '' ? shortId(id) : name;
    button.append(title);
    if (live) {
      const badge = document.createElement('span');
      badge.className = 'live';
      badge.textContent = 'Live';
      button.append(' ', badge);
    }
    button.addEventListener('click', () => {
      this.chosen(id);
    });
    const item = document.createElement('li');
    item.append(button);
    return item;
  }
}
