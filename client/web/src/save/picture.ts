// One picture of all that is shown: the water of each pane with its annotations, side by side as on the screen.

/** Canvases that lie over each other. */
export interface PicturePane {
  readonly water: HTMLCanvasElement;
  readonly annotations: HTMLCanvasElement;
  /** Draws both now: a canvas of WebGL can be read only as long as the script that has drawn it runs. */
  render(): void;
}

export class Picture {
  readonly canvas = document.createElement('canvas');
  private readonly context: CanvasRenderingContext2D;
  private readonly density: number;
  private readonly left: number;
  private readonly top: number;

  /** As large as the panes are now together, in their own pixels; even, as videos must be. */
  constructor(private readonly panes: readonly PicturePane[]) {
    const boxes = panes.map(({ water }) => water.getBoundingClientRect());
    const { water } = panes[0]!;
    this.density = water.width / water.clientWidth;
    this.left = Math.min(...boxes.map(({ left }) => left));
    this.top = Math.min(...boxes.map(({ top }) => top));
    const pixels = (length: number): number => Math.max(2, 2 * Math.floor((length * this.density) / 2));
    this.canvas.width = pixels(Math.max(...boxes.map(({ right }) => right)) - this.left);
    this.canvas.height = pixels(Math.max(...boxes.map(({ bottom }) => bottom)) - this.top);
    this.context = this.canvas.getContext('2d')!;
  }

  takeAll(): void {
    for (const pane of this.panes) {
      pane.render();
      this.take(pane);
    }
  }

  /** One that has just been drawn. */
  take({ water, annotations }: PicturePane): void {
    const { left, top, width, height } = water.getBoundingClientRect();
    const place = [left - this.left, top - this.top, width, height].map((length) => length * this.density) as [
      number,
      number,
      number,
      number,
    ];
    this.context.drawImage(water, ...place);
    if (annotations.width > 0) this.context.drawImage(annotations, ...place);
  }

  async png(): Promise<Uint8Array> {
    const blob = await new Promise<Blob | null>((resolve) => {
      this.canvas.toBlob(resolve, 'image/png');
    });
    if (!blob)
      throw new Error(
        `The browser makes no PNG of ${this.canvas.width} x ${this.canvas.height} pixels; a smaller window may do.`,
      );
    return new Uint8Array(await blob.arrayBuffer());
  }
}
