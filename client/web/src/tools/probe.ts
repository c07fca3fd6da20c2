// Shows the place and the value under the pointer.
import { element } from '../ui/page';
import { placeText } from '../ui/texts';
import type { Point } from '../view/bounds';
import type { Pick } from '../view/pick';

export interface ProbedValue {
  readonly title: string;
  /** None where there is none. */
  readonly text: string | undefined;
}

export class Probe {
  private readonly button = element('probe', HTMLButtonElement);
  private on = false;
  private at: Point | undefined;

  get active(): boolean {
    return this.on;
  }

  /** World units; none where there is no water. */
  get place(): Point | undefined {
    return this.at;
  }

  setActive(on: boolean): void {
    this.on = on;
    this.button.setAttribute('aria-pressed', String(on));
    element('probe-panel', HTMLElement).hidden = !on;
    this.at = undefined;
    this.write('Point at the water', '–', undefined);
  }

  /** picked: none where there is no water. value: what the surface is colored by, there. */
  show(picked: Pick | undefined, unit: string, decimals: number, value: ProbedValue | undefined): void {
    this.at = picked?.place;
    if (picked) this.write(placeText(picked.place, unit, decimals), picked.level ?? 'inside, on the cut', value);
    else this.write('no water there', '–', value);
  }

  private write(place: string, level: string, value: ProbedValue | undefined): void {
    element('probe-place', HTMLElement).textContent = place;
    element('probe-level', HTMLElement).textContent = level;
    element('probe-attribute', HTMLElement).hidden = !value;
    element('probe-title', HTMLElement).textContent = value?.title ?? '';
    element('probe-value', HTMLElement).textContent = value?.text ?? '–';
  }
}
