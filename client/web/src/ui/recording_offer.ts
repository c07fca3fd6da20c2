// The newest recording of a session that has ended, where the server has one.
import type { Recording } from '../gen/meniscus/v1/recording_service_pb';
import type { RecordingName } from '../recordings/recording_name';
import type { Server } from '../rpc/server';
import { element } from './page';

export class RecordingOffer {
  private readonly button = element('open-recording', HTMLButtonElement);
  private session: string | undefined;
  private recording: RecordingName | undefined;

  constructor(
    private readonly server: Server,
    chosen: (recording: RecordingName) => void,
  ) {
    this.button.addEventListener('click', () => {
      if (this.recording) chosen(this.recording);
    });
  }

  /** Until withdraw(). Looks for it once. */
  async offer(session: string): Promise<void> {
    if (session === this.session) return;
    this.session = session;
    // Servers that record nothing, and those that show this caller nothing, refuse.
    const recordings = await this.server.recordings().catch(() => []);
    if (session !== this.session) return;
    this.recording = newestOf(session, recordings);
    this.button.hidden = !this.recording;
  }

  withdraw(): void {
    this.session = undefined;
    this.recording = undefined;
    this.button.hidden = true;
  }
}

/** One without frames cannot be shown. */
export function newestOf(
  session: string,
  recordings: readonly Pick<Recording, 'sessionId' | 'number' | 'frames'>[],
): RecordingName | undefined {
  const numbers = recordings
    .filter(({ sessionId, frames }) => sessionId === session && frames > 0n)
    .map(({ number }) => number);
  return numbers.length > 0 ? { session, number: Math.max(...numbers) } : undefined;
}
