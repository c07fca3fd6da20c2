// The panel of the cut: its axis, side and place.
import { element } from '../ui/page';
import { decimalsOf, lengthText } from '../ui/texts';
import type { Point, WorldBox } from '../view/bounds';
import { sideTowards, type Cut } from '../view/cut';
import { axes, isAxis, type Axis } from '../view/up_axis';

export interface CutToolEvents {
  changed(cut: Cut | undefined): void;
  /** In which the plane can lie; none: there is nothing to cut. */
  box(): WorldBox | undefined;
  /** The place of the camera, world units. */
  camera(): Point;
}

export class CutTool {
  private readonly axis = element('cut-axis', HTMLSelectElement);
  private readonly slider = element('cut-at', HTMLInputElement);
  private readonly button = element('cut', HTMLButtonElement);
  private current: Cut | undefined;
  private unit = '';

  constructor(private readonly events: CutToolEvents) {
    this.axis.addEventListener('change', () => {
      if (isAxis(this.axis.value)) this.set(this.through(this.axis.value));
    });
    element('cut-side', HTMLButtonElement).addEventListener('click', () => {
      if (this.current) this.set({ ...this.current, away: this.current.away === 'beyond' ? 'before' : 'beyond' });
    });
    this.slider.addEventListener('input', () => {
      if (this.current) this.set({ ...this.current, at: Number(this.slider.value) });
    });
  }

  get cut(): Cut | undefined {
    return this.current;
  }

  toggle(): void {
    this.set(this.current ? undefined : this.through(isAxis(this.axis.value) ? this.axis.value : 'x'));
  }

  set(cut: Cut | undefined): void {
    this.current = cut;
    this.show();
    this.events.changed(cut);
  }

  setUnit(unit: string): void {
    this.unit = unit;
    this.show();
  }

  /** The water may have moved out of what the slider covers. */
  show(): void {
    const { current: cut } = this;
    element('cut-panel', HTMLElement).hidden = !cut;
    this.button.setAttribute('aria-pressed', String(cut !== undefined));
    if (!cut) return;
    const [low, high] = this.range(cut.axis);
    this.axis.value = cut.axis;
    this.slider.min = String(Math.min(low, cut.at));
    this.slider.max = String(Math.max(high, cut.at));
    this.slider.step = 'any';
    this.slider.value = String(cut.at);
    const text = lengthText(cut.at, this.unit, decimalsOf((high - low) / 10));
    element('cut-place', HTMLOutputElement).textContent = text;
    this.slider.setAttribute('aria-valuetext', text);
  }

  /** In the middle; what is towards the camera is taken away. */
  private through(axis: Axis): Cut | undefined {
    if (!this.events.box()) return undefined;
    const [low, high] = this.range(axis);
    const at = (low + high) / 2;
    return { axis, at, away: sideTowards(this.events.camera(), axis, at) };
  }

  private range(axis: Axis): [number, number] {
    const box = this.events.box();
    const i = axes.indexOf(axis);
    return box ? [box.min[i]!, box.max[i]!] : [0, 1];
  }
}
