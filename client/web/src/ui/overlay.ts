// The figures over the picture.
import type { Frame } from '../bricks/frame';
import type { Particles } from '../particles/particles';
import { triangleLevels } from '../decode/decoded_brick';
import { levelColors } from '../view/level_materials';
import { legendRow } from './legend';
import { element } from './page';
import { Rate } from './rates';
import { StageChart } from './stage_chart';
import { WarningList } from './warnings';
import { bytesText, countText, millisecondsText, volumeText } from './texts';

const unknown = '–';
const figures = ['frame', 'latency', 'skipped', 'particles', 'spray', 'volume', 'triangles'];

export class Overlay {
  private readonly drawn = new Rate();
  private readonly received = new Rate();
  private readonly chart = new StageChart();
  private readonly warnings = new WarningList(element('warnings', HTMLUListElement));
  private readonly levelTexts: HTMLElement[];

  constructor() {
    const list = element('levels', HTMLDListElement);
    this.levelTexts = triangleLevels.map((name, level) =>
      legendRow(list, name, `#${levelColors[level]!.toString(16).padStart(6, '0')}`),
    );
    setInterval(() => {
      this.refresh();
    }, 500);
  }

  receivedBytes(bytes: number): void {
    this.received.add(performance.now(), bytes);
  }

  clear(): void {
    for (const id of figures) set(id, unknown);
    for (const text of this.levelTexts) text.textContent = unknown;
    this.chart.clear();
    this.warnings.show([]);
  }

  /** When a picture of the frame has been drawn, new or from the frames that are kept. */
  frameDrawn(frame: Frame, levels: readonly number[]): void {
    set('frame', `${countText(frame.index)} (${frame.simulationTime.toFixed(2)} s)`);
    const { sprayParticles, volume, particleVolume } = frame.statistics;
    // Older recordings have no volumes.
    set('spray', particleVolume > 0 ? countText(sprayParticles) : unknown);
    set('volume', particleVolume > 0 ? volumeText(volume, particleVolume) : unknown);
    set('triangles', countText(frame.triangleCount));
    set('latency', unknown);
    this.levelTexts.forEach((text, level) => {
      text.textContent = countText(levels[level]!);
    });
    this.chart.describe(frame.statistics);
    this.warnings.show(frame.statistics.warnings);
  }

  /** Takes the particles of the frame that are drawn, if any are. */
  particlesDrawn(frame: Frame, drawn: Particles | undefined): void {
    const part = drawn && drawn.stride > 1 ? `, 1 in ${drawn.stride} drawn` : '';
    const other = drawn && drawn.index !== frame.index ? `, drawn of frame ${countText(drawn.index)}` : '';
    set('particles', countText(frame.statistics.particles) + part + other);
  }

  /** When that was its first. skipped: frames so far; roundTrip: of the link, ms. */
  liveFrameDrawn(frame: Frame, skipped: number, roundTrip: number): void {
    set('skipped', countText(skipped));
    set(
      'latency',
      millisecondsText(frame.statistics.latencySeconds * 1000 + roundTrip / 2 + performance.now() - frame.beganAt),
    );
    this.framePlayed(frame);
  }

  /** When that was its first, and the next one follows by itself. */
  framePlayed(frame: Frame): void {
    this.drawn.add(performance.now(), 1);
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
