// Draws meshes small, with the viewer's own picture, on a canvas that nobody sees.
import type { Shown } from '../bricks/brick_store';
import type { Frame } from '../bricks/frame';
import { joinNormals } from '../bricks/joined_normals';
import type { DecodePool } from '../decode/decode_pool';
import type { Theme } from '../view/environment';
import type { UpAxis } from '../view/up_axis';
import { Viewer } from '../view/viewer';

const noMargins = { top: 0, right: 0, bottom: 0, left: 0 };

export class ThumbnailPainter {
  private readonly canvas = document.createElement('canvas');
  /** From the first picture on: a page that is opened by a link needs none. */
  private viewer: Viewer | undefined;
  private theme: Theme = 'light';
  private target: HTMLCanvasElement | undefined;

  constructor(private readonly pool: DecodePool) {
    this.canvas.className = 'painting';
    this.canvas.setAttribute('aria-hidden', 'true');
  }

  /** Sets the theme of the pictures from now on. */
  setTheme(theme: Theme): void {
    this.theme = theme;
    this.viewer?.setTheme(theme);
  }

  /** Draws the frame; nothing where there is none. Throws Error where the browser cannot. */
  async draw(frame: Frame | undefined, up: UpAxis, target: HTMLCanvasElement, signal: AbortSignal): Promise<void> {
    const shown = frame && (await this.decode(frame));
    if (!shown || shown.bricks.size === 0 || signal.aborted) return;
    const viewer = this.start();
    this.target = target;
    viewer.setUp(up);
    viewer.show(shown);
    viewer.fit();
    // Draws at once.
    viewer.resize();
    this.target = undefined;
    viewer.clear();
  }

  private async decode(frame: Frame): Promise<Shown> {
    const bricks = await Promise.all(
      [...frame.bricks].map(
        async ([key, encoded]) =>
          [key, { encoded, decoded: await this.pool.decode(encoded, frame.offsetBits) }] as const,
      ),
    );
    return { frame, bricks: joinNormals(new Map(bricks), new Map(), frame.offsetBits) };
  }

  private start(): Viewer {
    if (!this.viewer) {
      document.body.append(this.canvas);
      this.viewer = new Viewer(this.canvas, () => noMargins, {
        drawn: () => {
          this.copy();
        },
        rendered: () => undefined,
        moving: () => undefined,
        lost: () => undefined,
      });
      this.viewer.setTheme(this.theme);
    }
    return this.viewer;
  }

  private copy(): void {
    if (!this.target) return;
    this.target.width = this.canvas.width;
    this.target.height = this.canvas.height;
    this.target.getContext('2d')?.drawImage(this.canvas, 0, 0);
    this.target.dataset.drawn = String(Number(this.target.dataset.drawn ?? 0) + 1);
  }
}
