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
import { bytesText, countText, millisecondsText, volumeText, withTime } from './texts';

const unknown = '–';
const figures = ['frame', 'latency', 'skipped', 'particles', 'spray', 'volume', 'triangles'];
/** Those that a stream alone has. */
const ofStream = ['bytes', 'skipped', 'quality'];

/** What is seen: a session that is being streamed, frames that follow by themselves, or a frame that rests. */
export type Seen = 'stream' | 'playing' | 'resting';

export class Overlay {
  private readonly drawn = new Rate();
  private readonly received = new Rate();
  private readonly chart = new StageChart();
  private readonly warnings = new WarningList(element('warnings', HTMLUListElement));
  private readonly levelTexts: HTMLElement[];
  private readonly box = element('overlay', HTMLElement);
  private seen: Seen = 'resting';

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

  /** Figures that do not apply to it are not shown. */
  setSeen(seen: Seen): void {
    this.seen = seen;
    this.showRows();
  }

  clear(): void {
    // Without a frame there are none.
    this.box.dataset.empty = '';
    this.seen = 'resting';
    for (const id of figures) set(id, unknown);
    this.showRows();
    for (const text of this.levelTexts) text.textContent = unknown;
    this.chart.clear();
    this.warnings.show([]);
  }

  /** When a picture of the frame has been drawn, new or from the frames that are kept. */
  frameDrawn(frame: Frame, levels: readonly number[]): void {
    delete this.box.dataset.empty;
    set('frame', withTime(countText(frame.index), frame));
    const { sprayParticles, volume, particleVolume } = frame.statistics;
    // Older recordings have no volumes.
    set('spray', particleVolume > 0 ? countText(sprayParticles) : unknown);
    set('volume', particleVolume > 0 ? volumeText(volume, particleVolume) : unknown);
    set('triangles', countText(frame.triangleCount));
    set('latency', unknown);
    this.showRows();
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
    this.showRows();
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

  private showRows(): void {
    const known = (id: string): boolean => element(id, HTMLElement).textContent !== unknown;
    element('rate-row', HTMLElement).hidden = this.seen === 'resting';
    for (const id of ofStream) element(`${id}-row`, HTMLElement).hidden = this.seen !== 'stream' || !known(id);
    element('latency-row', HTMLElement).hidden = !known('latency');
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
