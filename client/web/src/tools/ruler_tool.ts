// Measures from one point of the water to another.
import { element } from '../ui/page';
import { lengthText } from '../ui/texts';
import type { Point } from '../view/bounds';
import { measure } from '../view/ruler';
import { axes } from '../view/up_axis';

export class RulerTool {
  private readonly button = element('ruler', HTMLButtonElement);
  private ends: readonly Point[] = [];
  private on = false;

  get active(): boolean {
    return this.on;
  }

  /** None, one, or both ends. */
  get points(): readonly Point[] {
    return this.ends;
  }

  get both(): readonly [Point, Point] | undefined {
    const [from, to] = this.ends;
    return from && to && [from, to];
  }

  /** points: of a link. */
  setActive(on: boolean, points: readonly Point[] = []): void {
    this.on = on;
    this.ends = points;
    this.button.setAttribute('aria-pressed', String(on));
    element('ruler-panel', HTMLElement).hidden = !on;
  }

  /** The third one begins anew. */
  add(point: Point): void {
    this.ends = this.ends.length === 2 ? [point] : [...this.ends, point];
  }

  /** The distance in words; empty until there are both ends. */
  text(unit: string, decimals: number): string {
    return this.both ? lengthText(measure(...this.both).distance, unit, decimals) : '';
  }

  show(unit: string, decimals: number): void {
    const lines = this.both
      ? [
          this.text(unit, decimals),
          ...measure(...this.both).along.map((d, i) => `${axes[i]!}: ${lengthText(d, unit, decimals)}`),
        ]
      : [this.ends.length === 0 ? 'Tap the water where to measure from' : 'Tap the water where to measure to'];
    element('ruler-text', HTMLElement).textContent = lines.join('\n');
  }
}
