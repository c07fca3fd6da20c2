// The figures over the picture.
import type { Frame } from '../bricks/frame';
import { triangleLevels } from '../decode/decoded_brick';
import { levelColors } from '../view/level_materials';
import { element } from './page';
import { Rate } from './rates';
import { StageChart } from './stage_chart';
import { bytesText, countText, millisecondsText } from './texts';

export class Overlay {
  private readonly drawn = new Rate();
  private readonly received = new Rate();
  private readonly chart = new StageChart(element('stages', HTMLCanvasElement), element('stages-caption', HTMLElement));
  private readonly levelTexts: HTMLElement[];

  constructor() {
    const list = element('levels', HTMLDListElement);
    this.levelTexts = triangleLevels.map((name, level) => {
      const value = document.createElement('dd');
      const term = document.createElement('dt');
      const swatch = document.createElement('span');
      swatch.className = 'swatch';
      swatch.style.background = `#${levelColors[level]!.toString(16).padStart(6, '0')}`;
      term.append(swatch, name);
      const row = document.createElement('div');
      row.append(term, value);
      list.append(row);
      return value;
    });
    setInterval(() => { this.refresh(); }, 500);
  }

  receivedBytes(bytes: number): void {
    this.received.add(performance.now(), bytes);
  }

  /** Once for each frame, when its picture has been drawn. roundTrip: of the link, ms. */
  frameDrawn(frame: Frame, levels: readonly number[], skipped: number, roundTrip: number): void {
    const now = performance.now();
    this.drawn.add(now, 1);
    set('frame', `${countText(frame.index)} (${frame.simulationTime.toFixed(2)} s)`);
    set('triangles', countText(frame.triangleCount));
    set('skipped', countText(skipped));
    set('latency', millisecondsText(frame.statistics.latencySeconds * 1000 + roundTrip / 2 + now - frame.beganAt));
    this.levelTexts.forEach((text, level) => { text.textContent = countText(levels[level]!); });
    this.chart.add(frame.statistics);
    this.refresh();
  }

  setQuality(text: string): void {
    set('quality', text);
  }

  private refresh(): void {
    const now = performance.now();
    set('rate', String(this.drawn.perSecond(now)));
    set('bytes', `${bytesText(this.received.perSecond(now))}/s`);
  }
}

function set(id: string, text: string): void {
  element(id, HTMLElement).textContent = text;
}
