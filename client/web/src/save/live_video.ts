// A video of what is drawn, as it is drawn.
import type { Picture, PicturePane } from './picture';

const types = ['video/webm;codecs=vp9', 'video/webm', 'video/mp4'];

/** Why there is no video, for people; undefined where there can be one. */
export function whyNoRecorder(scope: { MediaRecorder?: unknown }): string | undefined {
  return scope.MediaRecorder === undefined
    ? 'This browser cannot record videos (it has no MediaRecorder). Another one may.'
    : undefined;
}

export interface RecordedVideo {
  readonly bytes: Uint8Array;
  readonly type: string;
}

export class LiveVideo {
  private readonly recorder: MediaRecorder;
  private readonly parts: Blob[] = [];
  private readonly stopped: Promise<void>;
  private asked = false;

  /** Begins at once. ended: the browser has stopped by itself; what there is comes by stop(). Throws where it cannot begin. */
  constructor(
    private readonly picture: Picture,
    ended: (reason: string) => void,
  ) {
    const mimeType = types.find((type) => MediaRecorder.isTypeSupported(type));
    this.recorder = new MediaRecorder(picture.canvas.captureStream(), {
      ...(mimeType ? { mimeType } : {}),
      videoBitsPerSecond: 6 * picture.canvas.width * picture.canvas.height,
    });
    this.recorder.addEventListener('dataavailable', ({ data }) => {
      this.parts.push(data);
    });
    // Also after an error.
    this.stopped = new Promise((resolve) => {
      this.recorder.addEventListener('stop', () => {
        resolve();
        if (!this.asked) ended('The browser has stopped recording the video: what there is of it is saved.');
      });
    });
    this.recorder.start(1000);
    // A canvas gives its stream what is drawn from now on.
    picture.takeAll();
  }

  /** One that has just been drawn. */
  take(pane: PicturePane): void {
    this.picture.take(pane);
  }

  /** Takes the pictures of all panes as they are now. */
  takeAll(): void {
    this.picture.takeAll();
  }

  /** Throws if nothing has been recorded. */
  async stop(): Promise<RecordedVideo> {
    this.asked = true;
    if (this.recorder.state !== 'inactive') await twoPictures();
    if (this.recorder.state !== 'inactive') this.recorder.stop();
    await this.stopped;
    const type = this.recorder.mimeType.replace(/;.*/, '');
    const bytes = new Uint8Array(await new Blob(this.parts).arrayBuffer());
    if (bytes.length === 0) throw new Error('the browser has recorded no picture.');
    return { bytes, type };
  }
}

/** Resolves after two pictures of the browser: the stream then has the drawing before. */
function twoPictures(): Promise<void> {
  return new Promise((resolve) => {
    requestAnimationFrame(() => {
      requestAnimationFrame(() => {
        resolve();
      });
    });
  });
}
