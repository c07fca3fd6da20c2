// A bar of colors with numbers below it and a title above.
import { colorOf, cssColor, type ColorMap } from '../color/color_maps';
import { partOf, rangeText, ticks, valueText, type ValueRange } from '../color/value_range';
import { drawText, type Pen } from './pen';

export interface ColorLegend {
  readonly title: string;
  /** None where each value has its own color. */
  readonly scale?: { readonly map: ColorMap; readonly range: ValueRange };
}

/** With what is left free below it, CSS pixels. */
export const legendHeight = 64;

/** CSS pixels. */
const widest = 300;
const barHeight = 12;
const aboveBar = 12;
const belowBar = 13;
/** Between two numbers. */
const gap = 14;

export function legendText({ title, scale }: ColorLegend): string {
  return scale ? `${title}: ${rangeText(scale.range)}` : title;
}

/** In the middle between left and right, its lower end at the bottom. */
export function drawColorLegend(
  pen: Pen,
  [left, right, bottom]: readonly [number, number, number],
  { title, scale }: ColorLegend,
): void {
  const width = Math.min(widest, right - left);
  const middle = (left + right) / 2;
  const barTop = bottom - belowBar - barHeight;
  drawText(pen, fitting(pen, title, right - left), [middle, scale ? barTop - aboveBar : bottom - 7]);
  if (!scale) return;
  const { context } = pen;
  const from = middle - width / 2;
  const { range, map } = scale;
  const gradient = context.createLinearGradient(from, 0, from + width, 0);
  const stops = 51;
  for (let i = 0; i <= stops; ++i) gradient.addColorStop(i / stops, cssColor(colorOf(map, i / stops)));
  context.fillStyle = pen.halo;
  context.fillRect(from - 2, barTop - 2, width + 4, barHeight + 4);
  context.fillStyle = gradient;
  context.fillRect(from, barTop, width, barHeight);
  for (const tick of fittingTicks(pen, range, width)) {
    const x = from + partOf(tick, range) * width;
    context.fillStyle = pen.color;
    context.fillRect(Math.round(x) - 0.5, barTop + barHeight, 1, 4);
    drawText(pen, tickText(tick, range), [x, bottom]);
  }
}

function tickText(tick: number, { low, high }: ValueRange): string {
  return valueText(tick, high - low);
}

/** As many as have room beside each other. */
function fittingTicks({ context }: Pen, range: ValueRange, width: number): number[] {
  for (let most = 6; most > 1; --most) {
    const chosen = ticks(range, most);
    const widths = chosen.map((tick) => context.measureText(tickText(tick, range)).width);
    const apart = chosen.length > 1 ? width * partOf(chosen[1]! - chosen[0]! + range.low, range) : Infinity;
    if (Math.max(...widths) + gap <= apart) return chosen;
  }
  return ticks(range, 1);
}

function fitting({ context }: Pen, text: string, width: number): string {
  if (context.measureText(text).width <= width) return text;
  let length = text.length;
  while (length > 1 && context.measureText(`${text.slice(0, length)}…`).width > width) --length;
  return `${text.slice(0, length)}…`;
}
