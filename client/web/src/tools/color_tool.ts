// The color of the surface: the choice of a quantity, its panel, and the consequences for each picture.
import type { VertexAttribute } from '../bricks/attributes';
import type { Shown } from '../bricks/brick_store';
import {
  colorText,
  componentNames,
  isRange,
  readUnit,
  type ColorChoice,
  type ColorLook,
  type ComponentName,
} from '../color/color_choice';
import { colorMapNames, isColorMap, isDiverging } from '../color/color_maps';
import { Quantity } from '../color/quantity';
import { aroundZero, rangeText, unionOfRanges, type ValueRange } from '../color/value_range';
import { element } from '../ui/page';
import type { ColorLegend } from '../view/color_legend';
import type { Spot } from '../view/pick';
import type { Coloring, Viewer } from '../view/viewer';
import type { ProbedValue } from './probe';

/** A picture, and what it shows. */
export interface ColoredPane {
  readonly viewer: Viewer;
  readonly shown: Shown | undefined;
}

export interface ColorToolEvents {
  /** The state that the link has. */
  changed(): void;
  /** Vertices are to carry another attribute, or none. */
  attribute(name: string | undefined): void;
  /** The session or the recording does not have the attribute that was chosen. */
  absent(reason: string): void;
  /** The first one is of what is looked at. */
  panes(): readonly ColoredPane[];
}

export class ColorTool {
  private readonly button = element('color', HTMLButtonElement);
  private readonly panel = element('color-panel', HTMLElement);
  private readonly attributeSelect = element('color-attribute', HTMLSelectElement);
  private readonly componentSelect = element('color-component', HTMLSelectElement);
  private readonly mapSelect = element('color-map', HTMLSelectElement);
  private readonly rangeSelect = element('color-range', HTMLSelectElement);
  private readonly ends = [element('color-low', HTMLInputElement), element('color-high', HTMLInputElement)] as const;
  private readonly unit = element('color-unit', HTMLInputElement);
  private readonly unlit = element('color-unlit', HTMLInputElement);
  private current: ColorChoice | undefined;
  /** The quantity of the choice, once a frame has announced the attribute. */
  private quantity: Quantity | undefined;
  /** The range over all frames that were shown. */
  private seen: ValueRange | undefined;
  private range: ValueRange | undefined;
  /** Whether the panel has shown that the attribute is not there. */
  private absenceShown = false;

  constructor(private readonly events: ColorToolEvents) {
    this.mapSelect.replaceChildren(...colorMapNames.map((name) => new Option(name)));
    this.attributeSelect.addEventListener('change', () => {
      const name = this.attributeSelect.value;
      this.choose(name === '' ? undefined : { ...this.other(), attribute: name });
    });
    this.componentSelect.addEventListener('change', () => {
      if (!this.current) return;
      const { attribute, map, range, unit, unlit } = this.current;
      const component = componentNames.find((name) => name === this.componentSelect.value);
      this.choose({ attribute, map, range, unit, unlit, ...(component ? { component } : {}) });
    });
    this.mapSelect.addEventListener('change', () => {
      if (this.current && isColorMap(this.mapSelect.value)) this.choose({ ...this.current, map: this.mapSelect.value });
    });
    this.rangeSelect.addEventListener('change', () => {
      const { value } = this.rangeSelect;
      if (!this.current) return;
      if (value !== 'hand') this.choose({ ...this.current, range: value === 'frame' ? 'frame' : 'session' });
      else this.choose({ ...this.current, range: this.byHand() });
    });
    this.unit.addEventListener('change', () => {
      const unit = readUnit(this.unit.value);
      if (this.current && unit !== undefined) this.choose({ ...this.current, unit });
    });
    this.unlit.addEventListener('change', () => {
      if (this.current) this.choose({ ...this.current, unlit: this.unlit.checked });
    });
    for (const end of this.ends)
      end.addEventListener('change', () => {
        const range = this.ends.map(({ valueAsNumber }) => valueAsNumber);
        if (this.current && isRange(range)) this.choose({ ...this.current, range });
        else this.writeRange();
      });
  }

  get choice(): ColorChoice | undefined {
    return this.current;
  }

  toggle(): void {
    this.setPanel(this.panel.hidden);
    if (!this.panel.hidden) this.attributeSelect.focus();
  }

  /** Something else is looked at. */
  open(choice: ColorChoice | undefined): void {
    this.setPanel(false);
    this.quantity = undefined;
    this.seen = undefined;
    this.set(choice);
  }

  /** None: water. */
  set(choice: ColorChoice | undefined): void {
    if (choice?.attribute !== this.current?.attribute || choice?.component !== this.current?.component) {
      this.quantity = undefined;
      this.seen = undefined;
    }
    this.current = choice;
    this.absenceShown = false;
    this.events.attribute(choice?.attribute);
    this.refresh();
  }

  /** Another frame is shown, before it is drawn. */
  refresh(): void {
    const panes = this.events.panes();
    this.learn(panes);
    const colored = panes.filter((pane) => this.isColored(pane));
    this.setRange(colored);
    for (const pane of panes) pane.viewer.setColoring(colored.includes(pane) ? this.coloring() : undefined);
    this.show();
  }

  /** The legend of the picture; none where it is not colored. */
  legend(viewer: Viewer): ColorLegend | undefined {
    const { quantity, current, range } = this;
    if (!quantity || !current || !viewer.colored) return undefined;
    const title = current.unit === '' ? quantity.title : `${quantity.title} (${current.unit})`;
    return { title, ...(range ? { scale: { map: current.map, range } } : {}) };
  }

  /** At a place of the picture; none where it is not colored. */
  valueAt(viewer: Viewer, spot: Spot | undefined): ProbedValue | undefined {
    const { quantity, range } = this;
    if (!quantity || !viewer.colored) return undefined;
    const extent = range ? range.high - range.low : 0;
    const text = spot && quantity.textAt(spot.brick, spot.points, spot.weights, extent);
    const unit = this.current?.unit ?? '';
    return { title: quantity.title, text: text === undefined || unit === '' ? text : `${text} ${unit}` };
  }

  private choose(choice: ColorChoice | undefined): void {
    this.set(choice);
    this.events.changed();
  }

  /** The look of the choice, for another attribute: numbers by hand, and a unit, were meant for this one. */
  private other(): ColorLook {
    const { map, range, unlit } = this.current ?? { map: colorMapNames[0], range: 'session' as const, unlit: false };
    return { map, range: typeof range === 'string' ? range : 'session', unit: '', unlit };
  }

  /** To begin with, what is there. */
  private byHand(): ColorChoice['range'] {
    const { low, high } = this.range ?? { low: 0, high: 1 };
    const round = (x: number): number => Number(x.toPrecision(4));
    const ends = [round(low), round(high)] as const;
    return isRange(ends) ? ends : [round(low), round(low) + 1];
  }

  /** Takes the form of the attribute from the first frame that has it. */
  private learn(panes: readonly ColoredPane[]): void {
    const { current } = this;
    if (!current || this.quantity) return;
    const forms = panes.map(({ shown }) => shown?.frame.attributes.find(({ name }) => name === current.attribute));
    const form = forms.find((found) => found !== undefined);
    if (form) this.quantity = new Quantity(form, current);
  }

  /** Whether all that is shown has the values, of the same form. */
  private isColored({ shown }: ColoredPane): boolean {
    const form = this.quantity?.form;
    if (!form || !shown) return false;
    const same = shown.frame.attributes.some(
      ({ name, type, components }) => name === form.name && type === form.type && components === form.components,
    );
    return same && [...shown.bricks.values()].every(({ decoded }) => decoded.attribute?.name === form.name);
  }

  private setRange(colored: readonly ColoredPane[]): void {
    const { quantity, current } = this;
    const frames = unionOfRanges(colored.map(({ shown }) => shown && quantity?.rangeOf(shown)));
    this.seen = unionOfRanges([this.seen, frames]);
    if (!current || quantity?.kind !== 'number') this.range = undefined;
    else if (typeof current.range !== 'string') this.range = { low: current.range[0], high: current.range[1] };
    else {
      const whole = current.range === 'frame' ? frames : this.seen;
      this.range = whole && isDiverging(current.map) ? aroundZero(whole) : whole;
    }
  }

  private coloring(): Coloring | undefined {
    const { quantity, current, range } = this;
    return quantity && current && { quantity, map: current.map, range, unlit: current.unlit };
  }

  private setPanel(open: boolean): void {
    this.panel.hidden = !open;
    this.button.setAttribute('aria-pressed', String(open));
  }

  private show(): void {
    const frame = this.events.panes()[0]?.shown?.frame;
    this.offer(frame?.attributes ?? []);
    const attribute = frame?.attributes.find(({ name }) => name === this.current?.attribute);
    const scaled = this.current !== undefined && this.quantity?.kind === 'number';
    this.showComponents(scaled ? attribute : undefined);
    for (const select of [this.mapSelect, this.rangeSelect]) select.parentElement!.hidden = !scaled;
    this.showRange(scaled ? this.current?.range : undefined);
    element('color-unit-row', HTMLElement).hidden = !scaled;
    element('color-unlit-row', HTMLElement).hidden = !this.current;
    if (this.current) {
      this.mapSelect.value = this.current.map;
      if (this.unit !== document.activeElement) this.unit.value = this.current.unit;
      this.unlit.checked = this.current.unlit;
    }
    this.writeRange();
    const absent = frame !== undefined && this.current !== undefined && !attribute;
    if (absent && !this.absenceShown) {
      this.setPanel(true);
      this.events.absent(this.problem()!);
    }
    this.absenceShown = absent;
  }

  /** The names, and the one that is chosen whether it is there or not. */
  private offer(attributes: readonly VertexAttribute[]): void {
    const chosen = this.current?.attribute;
    const names = attributes.map(({ name }) => name);
    if (chosen !== undefined && !names.includes(chosen)) names.push(chosen);
    const before = [...this.attributeSelect.options].slice(1).map(({ value }) => value);
    // A list that is open stays so.
    if (before.length === 0 || names.join() !== before.join())
      this.attributeSelect.replaceChildren(
        new Option('nothing (plain water)', ''),
        ...names.map((name) => new Option(name)),
      );
    this.attributeSelect.value = chosen ?? '';
  }

  private showComponents(attribute: VertexAttribute | undefined): void {
    const names: readonly ComponentName[] =
      attribute && attribute.components > 1 ? componentNames.slice(0, attribute.components) : [];
    this.componentSelect.parentElement!.hidden = names.length === 0;
    if (this.componentSelect.options.length !== names.length + 1)
      this.componentSelect.replaceChildren(new Option('magnitude', ''), ...names.map((name) => new Option(name)));
    const { component } = this.current ?? {};
    this.componentSelect.value = component !== undefined && names.includes(component) ? component : '';
  }

  private showRange(choice: ColorChoice['range'] | undefined): void {
    const byHand = choice !== undefined && typeof choice !== 'string';
    element('color-ends', HTMLElement).hidden = !byHand;
    if (choice !== undefined) this.rangeSelect.value = byHand ? 'hand' : choice;
    if (byHand)
      this.ends.forEach((end, i) => {
        if (end !== document.activeElement) end.value = String(choice[i]);
      });
  }

  /** The range, and any problem in words. */
  private writeRange(): void {
    write('color-numbers', this.range ? rangeText(this.range) : '');
    // Screen readers read it aloud when it changes.
    write('color-problem', this.problem() ?? '');
  }

  private problem(): string | undefined {
    const shown = this.events.panes()[0]?.shown;
    if (!shown) return undefined;
    const { attributes } = shown.frame;
    const none = 'No attribute is named in this session: --attribute velocity names one.';
    if (!this.current) return attributes.length === 0 ? none : undefined;
    const attribute = attributes.find(({ name }) => name === this.current!.attribute);
    if (!attribute)
      return `This session has no attribute "${this.current.attribute}". ${attributes.length === 0 ? none : ''}`.trim();
    if (!attribute.carried) return 'This frame came without the values.';
    const { component } = this.current;
    if (component !== undefined && componentNames.indexOf(component) >= attribute.components)
      return `There is no ${colorText(this.current)}: ${attribute.name} has ${attribute.components} component${attribute.components > 1 ? 's' : ''}.`;
    const [low, high] = this.ends.map(({ valueAsNumber }) => valueAsNumber);
    if (typeof this.current.range !== 'string' && !isRange([low, high])) return 'From must be less than to.';
    return undefined;
  }
}

function write(id: string, text: string): void {
  const place = element(id, HTMLElement);
  place.hidden = text === '';
  if (place.textContent !== text) place.textContent = text;
}
