// The sessions of the server, to choose one from. Follows by itself while it is shown.
import type { Session } from '../gen/meniscus/v1/session_service_pb';
import { FrameRates } from '../list/frame_rates';
import { newestMesh } from '../list/newest_mesh';
import { OnScreen } from '../list/on_screen';
import { givenName } from '../list/session_name';
import { inOrder, matches } from '../list/session_order';
import type { ThumbnailPainter } from '../list/thumbnail_painter';
import { Thumbnails } from '../list/thumbnails';
import type { Server } from '../rpc/server';
import { Code, explain, RpcError } from '../rpc/status';
import { factsOfSession } from '../scene_facts';
import { arrange } from './arrange';
import type { Banner } from './banner';
import { fillCommand, writeCommand } from './commands';
import { element } from './page';
import { followSearch, searched } from './search_field';
import { SessionCard } from './session_card';

/** ms */
const refreshEvery = 2000;

export class SessionList {
  private readonly list = element('sessions', HTMLUListElement);
  private readonly cards = new Map<string, SessionCard>();
  private readonly rates = new FrameRates();
  private readonly thumbnails: Thumbnails;
  /** Which cards are on the screen. */
  private readonly onScreen: OnScreen;
  private sessions: Session[] = [];
  private timer: ReturnType<typeof setTimeout> | undefined;
  /** One for each time that the list is shown: answers to requests of an earlier one are not for it. */
  private showing: symbol | undefined;

  constructor(
    private readonly server: Server,
    private readonly painter: ThumbnailPainter,
    private readonly banner: Banner,
    private readonly events: { chosen(session: string): void; tokenNeeded(reason: string): void },
  ) {
    this.thumbnails = new Thumbnails(
      (id, signal) => this.draw(id, signal),
      () => performance.now(),
    );
    this.onScreen = new OnScreen((id, visible) => {
      this.thumbnails.setVisible(id, visible && this.showing !== undefined);
    });
    document.addEventListener('visibilitychange', () => {
      if (!this.showing) return;
      if (document.hidden) this.thumbnails.stop();
      else this.show();
    });
    followSearch(() => {
      this.fill();
    });
  }

  show(): void {
    this.hide();
    this.showing = Symbol('showing');
    element('list', HTMLElement).hidden = false;
    void this.refresh(this.showing);
  }

  hide(): void {
    this.showing = undefined;
    clearTimeout(this.timer);
    this.thumbnails.stop();
    element('list', HTMLElement).hidden = true;
  }

  /** The pictures have other colors from now on. */
  themeChanged(): void {
    this.thumbnails.drawAnew();
  }

  private async refresh(showing: symbol): Promise<void> {
    try {
      const [info, sessions] = await Promise.all([this.server.info(), this.server.sessions()]);
      if (showing !== this.showing) return;
      element('server', HTMLElement).textContent = `meniscusd ${info.version}, ${info.backend} on ${info.device}`;
      writeCommand(element('fill-command', HTMLElement), fillCommand(location.hostname));
      this.sessions = sessions;
      this.rates.update(sessions, performance.now());
      this.fill();
      if (!document.hidden) this.thumbnails.update(sessions);
      this.banner.say('');
    } catch (error) {
      if (showing !== this.showing) return;
      if (error instanceof RpcError && (error.code === Code.unauthenticated || error.code === Code.permissionDenied)) {
        this.events.tokenNeeded(explain(error));
        return;
      }
      this.banner.countDown(explain(error), performance.now() + refreshEvery);
    }
    if (!document.hidden) this.timer = setTimeout(() => void this.refresh(showing), refreshEvery);
  }

  private fill(): void {
    const found = this.sessions.filter((session) => matches(searched(), givenName(session), session.id, session.owner));
    element('no-sessions', HTMLElement).hidden = this.sessions.length > 0;
    element('no-match', HTMLElement).hidden = this.sessions.length === 0 || found.length > 0;
    const ids = new Set(this.sessions.map(({ id }) => id));
    for (const [id, { item }] of this.cards)
      if (!ids.has(id)) {
        this.onScreen.remove(item);
        this.cards.delete(id);
      }
    arrange(
      this.list,
      inOrder(found).map((session) => {
        const card = this.cards.get(session.id) ?? this.addCard(session.id);
        card.show(session, this.rates.of(session.id), Date.now());
        return card.item;
      }),
    );
  }

  private addCard(id: string): SessionCard {
    const card = new SessionCard(id, () => {
      this.events.chosen(id);
    });
    this.cards.set(id, card);
    this.onScreen.add(card.item, id);
    return card;
  }

  private async draw(id: string, signal: AbortSignal): Promise<void> {
    const card = this.cards.get(id);
    const session = this.sessions.find((one) => one.id === id);
    if (!card || !session) return;
    const mesh = await newestMesh((maxLevel) => this.server.snapshot({ sessionId: id, maxLevel }, signal));
    await this.painter.draw(mesh, factsOfSession(session).up ?? 'y', card.picture, signal);
  }
}
