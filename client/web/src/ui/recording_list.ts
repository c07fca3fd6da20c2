// The server's recordings, below the sessions; not there where it records nothing. Follows by itself while it is shown.
import type { Recording } from '../gen/meniscus/v1/recording_service_pb';
import { recordingNameText, type RecordingName } from '../recordings/recording_name';
import { givenName } from '../list/session_name';
import { matches } from '../list/session_order';
import type { Server } from '../rpc/server';
import { Code, RpcError } from '../rpc/status';
import { showChoices } from './choices';
import { element } from './page';
import { followSearch, searched } from './search_field';
import { bytesText, countText } from './texts';

/** ms */
const refreshEvery = 5000;
/** The newest. */
const most = 100;

export class RecordingList {
  private readonly list = element('recordings', HTMLUListElement);
  private readonly section = element('recordings-section', HTMLElement);
  private timer: ReturnType<typeof setTimeout> | undefined;
  private last: Recording[] = [];
  /** As in SessionList. */
  private showing: symbol | undefined;

  constructor(
    private readonly server: Server,
    private readonly chosen: (recording: RecordingName) => void,
  ) {
    document.addEventListener('visibilitychange', () => {
      if (this.showing && !document.hidden) this.show();
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
  }

  private async refresh(showing: symbol): Promise<void> {
    try {
      const recordings = await this.server.recordings();
      if (showing !== this.showing) return;
      this.fill(recordings);
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
    showChoices(
      this.list,
      'recording',
      recordings.slice(0, most).map((recording) => {
        const name = { session: recording.sessionId, number: recording.number };
        return {
          name: recordingNameText(name),
          title: givenName(recording),
          about: about(recording),
          chosen: () => {
            this.chosen(name);
          },
        };
      }),
    );
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
