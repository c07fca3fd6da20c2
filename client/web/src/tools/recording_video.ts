// The dialog that makes a video of a recording: every frame once, drawn and encoded one after the other, however long each takes.
import type { Frame } from '../bricks/frame';
import { whyNoEncoder, VideoFile } from '../save/video_encoder';
import { Picture, type PicturePane } from '../save/picture';
import { explain } from '../rpc/status';
import { download } from '../ui/download';
import { element } from '../ui/page';
import { countText } from '../ui/texts';

export interface Recorded {
  readonly length: number;
  frames(signal: AbortSignal): AsyncIterable<Frame>;
  /** Resolves once a picture of the frame has been drawn. */
  draw(frame: Frame): Promise<void>;
  /** The screen is its own again. */
  done(): void;
}

const intro = 'Every frame once, as the picture shows it now.';

export class RecordingVideo {
  private readonly dialog = element('video-dialog', HTMLDialogElement);
  private readonly text = element('video-text', HTMLElement);
  private readonly rate = element('video-rate', HTMLInputElement);
  private readonly progress = element('video-progress', HTMLProgressElement);
  private readonly beginButton = element('video-begin', HTMLButtonElement);
  private recorded: Recorded | undefined;
  private panes: readonly PicturePane[] = [];
  private working: AbortController | undefined;

  constructor() {
    this.beginButton.addEventListener('click', () => void this.make());
    element('video-cancel', HTMLButtonElement).addEventListener('click', () => {
      this.dialog.close();
    });
    this.dialog.addEventListener('close', () => {
      this.working?.abort();
    });
  }

  /** While the dialog is open nothing else of the page can be used. */
  ask(recorded: Recorded, panes: readonly PicturePane[]): void {
    this.recorded = recorded;
    this.panes = panes;
    const missing = whyNoEncoder(window);
    this.text.textContent = missing ?? intro;
    // One that was canceled may not have ended yet: the next begins after it.
    this.setWorking(this.working !== undefined, missing !== undefined);
    this.dialog.showModal();
  }

  close(): void {
    this.dialog.close();
  }

  private setWorking(working: boolean, impossible = false): void {
    this.beginButton.disabled = working || impossible;
    this.rate.disabled = working || impossible;
    this.progress.hidden = !working;
  }

  private async make(): Promise<void> {
    const { recorded } = this;
    if (!recorded || this.working || !this.rate.reportValidity()) return;
    this.working = new AbortController();
    this.setWorking(true);
    try {
      const made = await this.encode(recorded, this.rate.valueAsNumber, this.working.signal);
      if (made) {
        download('meniscus.webm', 'video/webm', made);
        this.dialog.close();
      }
    } catch (error) {
      if (!this.working.signal.aborted) this.text.textContent = `There is no video: ${explain(error)}`;
    } finally {
      this.working = undefined;
      this.setWorking(false);
      recorded.done();
    }
  }

  /** None when it was canceled. */
  private async encode(recorded: Recorded, rate: number, signal: AbortSignal): Promise<Uint8Array | undefined> {
    const picture = new Picture(this.panes);
    const file = await VideoFile.begin({ width: picture.canvas.width, height: picture.canvas.height }, rate);
    try {
      let made = 0;
      for await (const frame of recorded.frames(signal)) {
        await recorded.draw(frame);
        if (signal.aborted) return undefined;
        picture.takeAll();
        await file.add(picture.canvas);
        ++made;
        this.progress.max = Math.max(recorded.length, made);
        this.progress.value = made;
        this.text.textContent = `${countText(made)} of ${countText(this.progress.max)} frames`;
      }
      return signal.aborted ? undefined : await file.finish();
    } finally {
      file.abandon();
    }
  }
}
