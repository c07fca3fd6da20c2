// A recording in the list: its picture, its name, what there is to say of it.
import type { Recording } from '../gen/meniscus/v1/recording_service_pb';
import { givenName, shortId } from '../list/session_name';
import { recordingNameText, type RecordingName } from '../recordings/recording_name';
import { showDeletion } from './delete_dialog';
import { icon } from './icon';
import { bytesText, countText } from './texts';

export class RecordingCard {
  readonly item = document.createElement('li');
  readonly picture = document.createElement('canvas');
  private readonly about = document.createElement('span');

  constructor(recording: Recording, chosen: (name: RecordingName) => void) {
    const name = { session: recording.sessionId, number: recording.number };
    const button = document.createElement('button');
    button.type = 'button';
    button.dataset.recording = recordingNameText(name);
    this.picture.className = 'thumbnail';
    this.picture.setAttribute('aria-hidden', 'true');
    const title = document.createElement('bdi');
    title.className = 'name';
    title.textContent = givenName(recording);
    title.hidden = title.textContent === '';
    const id = document.createElement('code');
    id.textContent = `${shortId(name.session)}/${name.number}`;
    id.title = recordingNameText(name);
    const heading = document.createElement('span');
    heading.className = 'heading';
    heading.append(title, id);
    this.about.className = 'about';
    const words = document.createElement('span');
    words.append(heading, this.about);
    button.append(this.picture, words);
    button.addEventListener('click', () => {
      chosen(name);
    });
    const remove = document.createElement('button');
    remove.type = 'button';
    remove.className = 'remove';
    remove.title = 'Delete';
    remove.setAttribute('aria-label', `Delete ${title.textContent} ${id.textContent}`.replace('  ', ' '));
    remove.append(icon('icon-delete'));
    remove.addEventListener('click', () => {
      showDeletion(name);
    });
    this.item.append(button, remove);
  }

  show(recording: Recording): void {
    this.about.textContent = about(recording);
  }
}

function about(recording: Recording): string {
  const parts = [
    new Date(Number(recording.startedAt / 1000n)).toLocaleString(),
    `${countText(recording.frames)} ${recording.frames === 1n ? 'frame' : 'frames'}`,
    bytesText(Number(recording.bytes)),
  ];
  if (recording.beingWritten) parts.push('being written');
  if (recording.damaged) parts.push('damaged behind them');
  if (recording.owner !== '') parts.push(`of ${recording.owner}`);
  return parts.join(', ');
}
