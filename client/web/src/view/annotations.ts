// The annotations over a picture: scale bar, axes, ruler, probe. On a canvas of their own, which pictures and videos are made of as well.
import { drawAxes } from './axes_gizmo';
import type { Point } from './bounds';
import { drawColorLegend, legendText, type ColorLegend } from './color_legend';
import type { Margins } from './fit';
import { drawLine, drawRing, drawText, type Pen } from './pen';
import { drawScaleBar, scaleBar, worldPerPixel } from './scale_bar';
import type { Viewer } from './viewer';

/** To be drawn, in world coordinates: the same over every picture. */
export interface Marks {
  /** Whether there are scale bar and axes. */
  readonly scale: boolean;
  readonly probe: Point | undefined;
  /** None, one or two points. */
  readonly ruler: readonly Point[];
  /** The text of a length on the scale bar, and of one on the ruler. */
  readonly scaleText: (length: number) => string;
  readonly rulerText: string;
  /** None where nothing is colored. */
  readonly legend: ColorLegend | undefined;
}

/** CSS pixels, from the left and from what covers the bottom. */
const inset = 18;
/** The room of scale bar and axes, and above them. */
const scaleWidth = 140;
const scaleHeight = 125;
/** Narrower, the legend lies above the scale. */
const narrowest = 150;

export class Annotations {
  private readonly context: CanvasRenderingContext2D;
  private drawn = false;

  constructor(
    readonly canvas: HTMLCanvasElement,
    private readonly viewer: Viewer,
    private readonly covered: () => Margins,
  ) {
    this.context = canvas.getContext('2d')!;
  }

  /** Over the picture as it is now; empty: whether there is no picture. */
  draw(marks: Marks, empty: boolean): void {
    const nothing = empty || (!marks.scale && !marks.probe && marks.ruler.length === 0 && !marks.legend);
    if (nothing && !this.drawn) return;
    this.drawn = !nothing;
    this.describeLegend(nothing ? undefined : marks.legend);
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const density = Math.min(2, devicePixelRatio);
    const [pixelsX, pixelsY] = [Math.round(width * density), Math.round(height * density)];
    if (this.canvas.width !== pixelsX) this.canvas.width = pixelsX;
    if (this.canvas.height !== pixelsY) this.canvas.height = pixelsY;
    this.context.resetTransform();
    this.context.clearRect(0, 0, pixelsX, pixelsY);
    if (nothing || width === 0) return;
    const pen = this.pen(density);
    if (marks.scale) this.drawScale(pen, marks, height);
    if (marks.legend) this.drawLegend(pen, marks.legend, marks.scale, width, height);
    this.drawMeasured(pen, marks);
    const probe = marks.probe && this.onCanvas(marks.probe);
    if (probe) drawRing(pen, probe, 6);
  }

  private pen(density: number): Pen {
    const { context } = this;
    context.setTransform(density, 0, 0, density, 0, 0);
    context.font = '600 13px system-ui, sans-serif';
    const style = getComputedStyle(this.canvas);
    return { context, color: style.color, halo: style.getPropertyValue('--page') };
  }

  private drawScale(pen: Pen, marks: Marks, height: number): void {
    const { camera } = this.viewer;
    const bottom = height - this.covered().bottom - inset;
    const { length, pixels } = scaleBar(worldPerPixel(this.viewer.viewDistance, camera.fov, height));
    drawScaleBar(pen, [inset, bottom], pixels, marks.scaleText(length));
    drawAxes(pen, [inset + 34, bottom - 66], this.viewer.upAxis, camera.quaternion);
    // For readers outside of the page: tests, and assistive tools.
    this.canvas.dataset.scale = marks.scaleText(length);
  }

  private drawLegend(pen: Pen, legend: ColorLegend, scale: boolean, width: number, height: number): void {
    const covered = this.covered();
    const right = width - covered.right - inset;
    const bottom = height - covered.bottom - inset;
    const beside = inset + scaleWidth;
    const above = scale && right - beside < narrowest;
    drawColorLegend(pen, [scale && !above ? beside : inset, right, above ? bottom - scaleHeight : bottom], legend);
  }

  /** For readers outside of the page: tests, and assistive tools. */
  private describeLegend(legend: ColorLegend | undefined): void {
    if (legend) this.canvas.dataset.legend = legendText(legend);
    else delete this.canvas.dataset.legend;
  }

  private drawMeasured(pen: Pen, { ruler, rulerText }: Marks): void {
    const points = ruler.map((point) => this.onCanvas(point)).filter((point) => point !== undefined);
    const [from, to] = points;
    if (from && to) drawLine(pen, [from, to]);
    for (const point of points) drawRing(pen, point, 4);
    if (from && to) drawText(pen, rulerText, [(from[0] + to[0]) / 2, (from[1] + to[1]) / 2 - 14]);
  }

  /** CSS pixels; none behind the camera. */
  private onCanvas(point: Point): readonly [number, number] | undefined {
    const place = this.viewer.inScene(point).project(this.viewer.camera);
    if (place.z > 1) return undefined;
    return [((place.x + 1) / 2) * this.canvas.clientWidth, ((1 - place.y) / 2) * this.canvas.clientHeight];
  }
}
