// The second picture: which session it is of, and that both are looked at from one place.
import { BesideView } from '../beside_view';
import type { Shown } from '../bricks/brick_store';
import type { DecodePool } from '../decode/decode_pool';
import type { Session } from '../gen/meniscus/v1/session_service_pb';
import { givenName, shortId } from '../list/session_name';
import type { Server } from '../rpc/server';
import { explain } from '../rpc/status';
import { element } from '../ui/page';
import { coveredMargins } from '../ui/panels';
import type { Theme } from '../view/environment';
import { Viewer } from '../view/viewer';
import { Pane } from './pane';

export interface BesideToolEvents {
  /** Another session, or none. */
  changed(): void;
  /** A frame has taken the place of the one before. */
  shown(): void;
  /** A picture has been drawn. */
  rendered(pane: Pane): void;
  moving(moving: boolean): void;
}

export class BesideTool {
  private readonly button = element('beside', HTMLButtonElement);
  private readonly select = element('beside-session', HTMLSelectElement);
  private readonly title = element('beside-title', HTMLElement);
  private readonly frame = element('pane-beside', HTMLElement);
  private readonly water = element('view-beside', HTMLCanvasElement);
  /** Made when it is first needed: pages that show one session draw with one context. */
  private made: { readonly pane: Pane; readonly view: BesideView } | undefined;
  private chosen: string | undefined;
  private first: string | undefined;
  /** The names of the sessions that were offered, by id. */
  private names = new Map<string, string>();
  /** The last remark about the session that is shown. */
  private said = '';
  private theme: Theme = 'light';
  private attribute: string | undefined;

  constructor(
    private readonly server: Server,
    private readonly pool: DecodePool,
    private readonly main: Viewer,
    private readonly events: BesideToolEvents,
  ) {
    this.select.addEventListener('change', () => {
      this.show(this.select.value === '' ? undefined : this.select.value);
      this.events.changed();
    });
  }

  get session(): string | undefined {
    return this.chosen;
  }

  get pane(): Pane | undefined {
    return this.chosen === undefined ? undefined : this.made?.pane;
  }

  /** The content of its pane. */
  get shown(): Shown | undefined {
    return this.chosen === undefined ? undefined : this.made?.view.shown;
  }

  /** That vertices are to carry. */
  setAttribute(name: string | undefined): void {
    this.attribute = name;
    this.made?.view.setAttribute(name);
  }

  /** first: the session that is looked at, which is not offered; second: the one of a link. */
  open(first: string | undefined, second: string | undefined): void {
    this.first = first;
    this.setPanel(second !== undefined);
    this.show(second);
  }

  /** Opens the panel, and closes it with what it has chosen. */
  toggle(): void {
    const open = element('beside-panel', HTMLElement).hidden;
    this.setPanel(open);
    if (open) {
      this.select.focus();
      return;
    }
    this.show(undefined);
    this.events.changed();
  }

  setPaused(paused: boolean): void {
    this.made?.view.setPaused(paused);
  }

  /** With another token. */
  restart(): void {
    if (this.chosen !== undefined) this.made?.view.restart();
  }

  setTheme(theme: Theme): void {
    this.theme = theme;
    this.made?.pane.viewer.setTheme(theme);
  }

  /** As the main picture is now. */
  follow(): void {
    this.pane?.viewer.mirror(this.main);
  }

  private setPanel(open: boolean): void {
    element('beside-panel', HTMLElement).hidden = !open;
    this.button.setAttribute('aria-pressed', String(open));
    if (open) void this.offer();
  }

  private show(session: string | undefined): void {
    if (session === undefined && !this.made) return;
    this.chosen = session;
    this.frame.hidden = session === undefined;
    element('stage', HTMLElement).classList.toggle('two', session !== undefined);
    this.main.setBeside(undefined);
    this.made ??= this.make();
    this.made.view.stop();
    delete this.water.dataset.frame;
    delete this.water.dataset.triangles;
    if (session === undefined) return;
    this.made.view.start(session);
    this.say('');
    this.follow();
  }

  private make(): { pane: Pane; view: BesideView } {
    const covered = () => coveredMargins(this.water);
    const viewer = new Viewer(this.water, covered, {
      rendered: () => {
        this.events.rendered(pane);
      },
      drawn: (frame, triangles) => {
        this.water.dataset.frame = String(frame.index);
        this.water.dataset.triangles = String(triangles);
      },
      moving: (moving) => {
        this.events.moving(moving);
      },
      lost: (lost) => {
        this.say(lost ? 'The browser has taken the graphics away.' : '');
      },
    });
    viewer.setTheme(this.theme);
    const pane = new Pane(this.water, element('annotations-beside', HTMLCanvasElement), viewer, covered);
    const view = new BesideView(this.server, this.pool, viewer, {
      shown: (box) => {
        this.main.setBeside(box);
        this.events.shown();
      },
      domain: (box) => {
        viewer.setDomain(box);
      },
      says: (text) => {
        this.say(text);
      },
    });
    view.setAttribute(this.attribute);
    return { pane, view };
  }

  private say(text: string): void {
    this.said = text;
    const name = this.chosen === undefined ? '' : (this.names.get(this.chosen) ?? this.chosen);
    this.title.textContent = [name, text].filter((part) => part !== '').join(': ');
  }

  /** Fills the list of sessions. */
  private async offer(): Promise<void> {
    let reason = '';
    const sessions = await this.server.sessions().catch((error: unknown) => {
      reason = explain(error);
      return [];
    });
    const others = sessions.filter(({ id }) => id !== this.first);
    const names = new Map(others.map((session) => [session.id, nameOf(session)]));
    if (this.chosen !== undefined && !names.has(this.chosen)) names.set(this.chosen, this.chosen);
    const none = reason !== '' ? reason : names.size === 0 ? 'There is no other session' : 'Choose a session';
    this.select.replaceChildren(new Option(none, ''), ...[...names].map(([id, name]) => new Option(name, id)));
    this.select.value = this.chosen ?? '';
    this.names = names;
    this.say(this.said);
  }
}

function nameOf(session: Session): string {
  const name = givenName(session);
  return name === '' ? session.id : `${name} (${shortId(session.id)})`;
}
