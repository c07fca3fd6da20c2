// The sessions of the server, to choose one from. Follows by itself while it is shown.
import type { Session } from '../gen/meniscus/v1/session_service_pb';
import type { Server } from '../rpc/server';
import { Code, explain, RpcError } from '../rpc/status';
import type { Banner } from './banner';
import { showChoices } from './choices';
import { element } from './page';
import { countText } from './texts';

/** ms */
const refreshEvery = 2000;

export class SessionList {
  private readonly list = element('sessions', HTMLUListElement);
  private timer: ReturnType<typeof setTimeout> | undefined;
  /** One for each time that the list is shown: answers to requests of an earlier one are not for it. */
  private showing: symbol | undefined;

  constructor(
    private readonly server: Server,
    private readonly banner: Banner,
    private readonly events: { chosen(session: string): void; tokenNeeded(reason: string): void },
  ) {
    document.addEventListener('visibilitychange', () => {
      if (this.showing && !document.hidden) this.show();
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
    element('list', HTMLElement).hidden = true;
  }

  private async refresh(showing: symbol): Promise<void> {
    try {
      const [info, sessions] = await Promise.all([this.server.info(), this.server.sessions()]);
      if (showing !== this.showing) return;
      element('server', HTMLElement).textContent = `meniscusd ${info.version}, ${info.backend} on ${info.device}`;
      this.fill(sessions);
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

  private fill(sessions: Session[]): void {
    element('no-sessions', HTMLElement).hidden = sessions.length > 0;
    showChoices(
      this.list,
      'session',
      sessions.map((session) => ({
        name: session.id,
        about: about(session),
        chosen: () => {
          this.events.chosen(session.id);
        },
      })),
    );
  }
}

function about(session: Session): string {
  const parts = [
    session.uploading ? 'streaming' : 'idle',
    `${countText(session.frames)} ${session.frames === 1n ? 'frame' : 'frames'}`,
    `${session.watchers} ${session.watchers === 1 ? 'watcher' : 'watchers'}`,
  ];
  if (session.lastFrame)
    parts.push(
      `${countText(session.lastFrame.particles)} particles`,
      `${countText(session.lastFrame.triangles)} triangles`,
    );
  if (session.owner !== '') parts.push(`of ${session.owner}`);
  return parts.join(', ');
}
