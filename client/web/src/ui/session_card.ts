// A session in the list: its picture, its name, what there is to say of it.
import type { Session } from '../gen/meniscus/v1/session_service_pb';
import { givenName, shortId } from '../list/session_name';
import { ageText, countText, rateText } from './texts';

export class SessionCard {
  readonly item = document.createElement('li');
  readonly picture = document.createElement('canvas');
  private readonly live = document.createElement('span');
  private readonly name = document.createElement('bdi');
  private readonly id = document.createElement('code');
  private readonly about = document.createElement('span');

  constructor(session: string, chosen: () => void) {
    const button = document.createElement('button');
    button.type = 'button';
    button.dataset.session = session;
    this.picture.className = 'thumbnail';
    this.picture.setAttribute('aria-hidden', 'true');
    this.live.className = 'live';
    this.live.textContent = 'Live';
    this.name.className = 'name';
    this.about.className = 'about';
    this.id.textContent = shortId(session);
    this.id.title = session;
    const heading = document.createElement('span');
    heading.className = 'heading';
    heading.append(this.name, this.id, this.live);
    const words = document.createElement('span');
    words.append(heading, this.about);
    button.append(this.picture, words);
    button.addEventListener('click', chosen);
    this.item.append(button);
  }

  /** rate: frames a second, where it is known. now: ms since 1970. */
  show(session: Session, rate: number | undefined, now: number): void {
    const name = givenName(session);
    this.name.textContent = name;
    this.name.hidden = name === '';
    this.live.hidden = !session.uploading;
    this.about.textContent = about(session, rate, now);
  }
}

function about(session: Session, rate: number | undefined, now: number): string {
  const parts = [
    session.uploading ? (rate === undefined ? 'streaming' : rateText(rate)) : 'not streaming',
    `${countText(session.frames)} ${session.frames === 1n ? 'frame' : 'frames'}`,
  ];
  if (session.lastFrame)
    parts.push(
      `${countText(session.lastFrame.particles)} particles`,
      `${countText(session.lastFrame.triangles)} triangles`,
    );
  parts.push(`${session.watchers} ${session.watchers === 1 ? 'watcher' : 'watchers'}`);
  // Older servers do not send the time.
  if (session.createdAt > 0n) parts.push(`made ${ageText(now / 1000 - Number(session.createdAt) / 1e6)} ago`);
  if (session.owner !== '') parts.push(`of ${session.owner}`);
  return parts.join(', ');
}
