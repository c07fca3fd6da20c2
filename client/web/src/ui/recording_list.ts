// The server's recordings, below the sessions; not there where it records nothing. Follows by itself while it is shown.
import type { Recording } from '../gen/meniscus/v1/recording_service_pb';
import { frameOf } from '../list/newest_mesh';
import { OnScreen } from '../list/on_screen';
import type { ThumbnailPainter } from '../list/thumbnail_painter';
import { Thumbnails } from '../list/thumbnails';
import { recordingNameText, type RecordingName } from '../recordings/recording_name';
import { givenName } from '../list/session_name';
import { matches } from '../list/session_order';
import type { Server } from '../rpc/server';
import { Code, RpcError } from '../rpc/status';
import { factsOfRecording } from '../scene_facts';
import { arrange } from './arrange';
import { element } from './page';
import { followSearch, searched } from './search_field';
import { RecordingCard } from './recording_card';
import { countText } from './texts';

/** ms */
const refreshEvery = 5000;
/** The newest. */
const most = 100;
/** Of one frame, particles and mesh: of larger ones no picture is fetched. */
const pictureBytes = 24 << 20;

export class RecordingList {
  private readonly list = element('recordings', HTMLUListElement);
  private readonly section = element('recordings-section', HTMLElement);
  private timer: ReturnType<typeof setTimeout> | undefined;
  private last: Recording[] = [];
  private readonly cards = new Map<string, RecordingCard>();
  private readonly thumbnails: Thumbnails;
  private readonly onScreen: OnScreen;
  /** As in SessionList. */
  private showing: symbol | undefined;

  constructor(
    private readonly server: Server,
    private readonly painter: ThumbnailPainter,
    private readonly chosen: (recording: RecordingName) => void,
  ) {
    this.thumbnails = new Thumbnails(
      (name, signal) => this.draw(name, signal),
      () => performance.now(),
    );
    this.onScreen = new OnScreen((name, visible) => {
      this.thumbnails.setVisible(name, visible && this.showing !== undefined);
    });
    document.addEventListener('visibilitychange', () => {
      if (!this.showing) return;
      if (document.hidden) this.thumbnails.stop();
      else this.show();
    });
    followSearch(() => {
      this.fill(this.last);
    });
  }

  show(): void {
    this.hide();
    this.showing = Symbol('showing');
    void this.refresh(this.showing);
  }

  hide(): void {
    this.showing = undefined;
    clearTimeout(this.timer);
    this.thumbnails.stop();
  }

  /** The pictures have other colors from now on. */
  themeChanged(): void {
    this.thumbnails.drawAnew();
  }

  private async refresh(showing: symbol): Promise<void> {
    try {
      const recordings = await this.server.recordings();
      if (showing !== this.showing) return;
      this.fill(recordings);
      // One picture of each does.
      if (!document.hidden)
        this.thumbnails.update(
          recordings.map((recording) => ({ id: nameOf(recording), frames: recording.frames > 0n ? 1n : 0n })),
        );
    } catch (error) {
      if (showing !== this.showing) return;
      // The list of sessions shows other errors.
      if (error instanceof RpcError && error.code === Code.unimplemented) {
        this.fill([]);
        return;
      }
    }
    if (!document.hidden) this.timer = setTimeout(() => void this.refresh(showing), refreshEvery);
  }

  private fill(all: Recording[]): void {
    this.last = all;
    this.section.hidden = all.length === 0;
    const recordings = all.filter((recording) =>
      matches(searched(), givenName(recording), recording.sessionId, recording.owner),
    );
    const more = element('more-recordings', HTMLElement);
    more.hidden = recordings.length <= most;
    more.textContent = `These are the newest ${most} of ${countText(recordings.length)}.`;
    const names = new Set(all.map(nameOf));
    for (const [name, { item }] of this.cards)
      if (!names.has(name)) {
        this.onScreen.remove(item);
        this.cards.delete(name);
      }
    arrange(
      this.list,
      recordings.slice(0, most).map((recording) => {
        const card = this.cards.get(nameOf(recording)) ?? this.addCard(recording);
        card.show(recording);
        return card.item;
      }),
    );
  }

  private addCard(recording: Recording): RecordingCard {
    const card = new RecordingCard(recording, this.chosen);
    this.cards.set(nameOf(recording), card);
    this.onScreen.add(card.item, nameOf(recording));
    return card;
  }

  /** A frame of its last third: in the first one little has happened. */
  private async draw(name: string, signal: AbortSignal): Promise<void> {
    const card = this.cards.get(name);
    const recording = this.last.find((one) => nameOf(one) === name);
    if (!card || !recording || recording.bytes / recording.frames > pictureBytes) return;
    const { sessionId, number, frames } = recording;
    const read = this.server.readRecording({ sessionId, number, position: (2n * frames) / 3n, count: 1n }, signal);
    await this.painter.draw(await frameOf(read), factsOfRecording(recording).up ?? 'y', card.picture, signal);
  }
}

function nameOf({ sessionId, number }: Recording): string {
  return recordingNameText({ session: sessionId, number });
}
