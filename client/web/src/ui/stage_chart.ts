// The method's steps of the last frames, stacked: a column per frame. Below it, those of the frame on the screen.
import type { FrameStatistics, StageSeconds } from '../gen/meniscus/v1/mesh_pb';
import { legendRow } from './legend';
import { element } from './page';
import { millisecondsText } from './texts';

const stages = [
  ['registerParticles', 'register', '#6b8fb5'],
  ['splitCells', 'split', '#3f9f85'],
  ['adjustLevels', 'adjust', '#a0a63a'],
  ['sampleField', 'sample', '#e09a35'],
  ['countTriangles', 'count', '#d9624a'],
  ['placeVertices', 'place', '#b05c9c'],
  ['emitTriangles', 'emit', '#7d77d6'],
  ['fillCracks', 'cracks', '#8d8d8d'],
] as const satisfies readonly (readonly [keyof StageSeconds, string, string])[];
const columnWidth = 4;

export class StageChart {
  private readonly canvas = element('stages', HTMLCanvasElement);
  private readonly reconstruction = element('reconstruction', HTMLElement);
  private readonly encoding = element('encoding', HTMLElement);
  private readonly values: HTMLElement[];
  private readonly frames: number[][] = [];

  constructor() {
    const legend = element('stages-legend', HTMLDListElement);
    this.values = stages.map(([, name, color]) => legendRow(legend, name, color));
  }

  clear(): void {
    this.frames.length = 0;
    for (const value of [this.reconstruction, this.encoding, ...this.values]) value.textContent = '–';
    this.draw();
  }

  add({ stageSeconds }: FrameStatistics): void {
    if (!stageSeconds) return;
    this.frames.push(stages.map(([key]) => stageSeconds[key]));
    if (this.frames.length > this.canvas.width / columnWidth) this.frames.shift();
    this.draw();
  }

  describe({ stageSeconds, totalSeconds, encodeSeconds }: FrameStatistics): void {
    this.reconstruction.textContent = millisecondsText(totalSeconds * 1000);
    this.encoding.textContent = millisecondsText(encodeSeconds * 1000);
    stages.forEach(([key], i) => {
      this.values[i]!.textContent = millisecondsText((stageSeconds?.[key] ?? 0) * 1000);
    });
  }

  private draw(): void {
    const context = this.canvas.getContext('2d');
    if (!context) return;
    // Of a frame that rests there is no history.
    this.canvas.hidden = this.frames.length === 0;
    const { width, height } = this.canvas;
    context.clearRect(0, 0, width, height);
    const scale = height / Math.max(...this.frames.map(sum), 1e-6);
    this.frames.forEach((seconds, column) => {
      let y = height;
      seconds.forEach((second, stage) => {
        const tall = second * scale;
        y -= tall;
        context.fillStyle = stages[stage]![2];
        context.fillRect(column * columnWidth, y, columnWidth - 1, tall);
      });
    });
  }
}

function sum(values: number[]): number {
  return values.reduce((total, value) => total + value, 0);
}
