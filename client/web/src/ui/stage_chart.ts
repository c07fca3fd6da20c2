// The method's steps of the last frames, stacked: a column per frame.
import type { FrameStatistics, StageSeconds } from '../gen/meniscus/v1/mesh_pb';
import { millisecondsText } from './texts';

const stages = [
  ['registerParticles', 'register particles', '#6b8fb5'],
  ['splitCells', 'split cells', '#3f7f6d'],
  ['adjustLevels', 'adjust levels', '#a0a63a'],
  ['sampleField', 'sample field', '#d08a2e'],
  ['countTriangles', 'count triangles', '#c4553f'],
  ['placeVertices', 'place vertices', '#9c4f8a'],
  ['emitTriangles', 'emit triangles', '#5d58a8'],
  ['fillCracks', 'fill cracks', '#7d7d7d'],
] as const satisfies readonly (readonly [keyof StageSeconds, string, string])[];
const columnWidth = 4;

export class StageChart {
  private readonly frames: number[][] = [];

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly caption: HTMLElement,
  ) {}

  add({ stageSeconds, encodeSeconds }: FrameStatistics): void {
    if (!stageSeconds) return;
    const seconds = stages.map(([key]) => stageSeconds[key]);
    this.frames.push(seconds);
    if (this.frames.length > this.canvas.width / columnWidth) this.frames.shift();
    this.describe(seconds, encodeSeconds);
    this.draw();
  }

  private describe(seconds: number[], encodeSeconds: number): void {
    const longest = seconds.indexOf(Math.max(...seconds));
    this.caption.textContent =
      `Reconstruction ${millisecondsText(sum(seconds) * 1000)}, most in ${stages[longest]![1]} ` +
      `(${millisecondsText(seconds[longest]! * 1000)}); encoding ${millisecondsText(encodeSeconds * 1000)}`;
    this.canvas.title = stages.map(([, name], i) => `${name}: ${millisecondsText(seconds[i]! * 1000)}`).join('\n');
  }

  private draw(): void {
    const context = this.canvas.getContext('2d');
    if (!context) return;
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
