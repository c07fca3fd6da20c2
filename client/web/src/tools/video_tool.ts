// A video: of what is live, from one press of the button to the next; of a recording, by its dialog.
import { LiveVideo, whyNoRecorder } from '../save/live_video';
import { Picture, type PicturePane } from '../save/picture';
import { download } from '../ui/download';
import { element } from '../ui/page';
import { RecordingVideo, type Recorded } from './recording_video';

export class VideoTool {
  private readonly button = element('video', HTMLButtonElement);
  private readonly dialog = new RecordingVideo();
  private live: LiveVideo | undefined;

  constructor(private readonly failed: (reason: string) => void) {}

  /** recorded: where a recording is looked at. */
  toggle(panes: readonly PicturePane[], recorded: Recorded | undefined): void {
    if (this.live) {
      // It lasts until now, also where nothing has moved.
      this.live.takeAll();
      void this.finish();
    } else if (recorded) this.dialog.ask(recorded, panes);
    else this.begin(panes);
  }

  /** A picture of the pane has been drawn. */
  take(pane: PicturePane): void {
    this.live?.take(pane);
  }

  /** Saves the part of a live video that there is. */
  stop(): void {
    this.dialog.close();
    if (this.live) void this.finish();
  }

  private begin(panes: readonly PicturePane[]): void {
    const missing = whyNoRecorder(window);
    if (missing !== undefined) {
      this.failed(missing);
      return;
    }
    try {
      const live = new LiveVideo(new Picture(panes), (reason) => {
        this.failed(reason);
        if (this.live === live) void this.finish();
      });
      this.setLive(live);
    } catch (error) {
      this.fail(error);
    }
  }

  private async finish(): Promise<void> {
    const { live } = this;
    this.setLive(undefined);
    try {
      const { bytes, type } = await live!.stop();
      download(`meniscus.${type === 'video/mp4' ? 'mp4' : 'webm'}`, type, bytes);
    } catch (error) {
      this.fail(error);
    }
  }

  private fail(error: unknown): void {
    this.failed(`There is no video: ${error instanceof Error ? error.message : String(error)}`);
  }

  private setLive(live: LiveVideo | undefined): void {
    this.live = live;
    this.button.setAttribute('aria-pressed', String(live !== undefined));
    this.button.title = live ? 'End the video and save it' : 'Save a video';
  }
}
