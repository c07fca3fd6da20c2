// The numbers from the least to the greatest, and round ones among them.

export interface ValueRange {
  readonly low: number;
  readonly high: number;
}

/** The union of the ranges that are there; none of none. */
export function unionOfRanges(ranges: readonly (ValueRange | undefined)[]): ValueRange | undefined {
  const there = ranges.filter((range) => range !== undefined);
  if (there.length === 0) return undefined;
  return { low: Math.min(...there.map(({ low }) => low)), high: Math.max(...there.map(({ high }) => high)) };
}

/** With zero in the middle, where it lies within. */
export function aroundZero({ low, high }: ValueRange): ValueRange {
  if (low >= 0 || high <= 0) return { low, high };
  const end = Math.max(-low, high);
  return { low: -end, high: end };
}

/** Where the value lies, from 0 to 1; in the middle of a range without extent. */
export function partOf(value: number, { low, high }: ValueRange): number {
  return high > low ? (value - low) / (high - low) : 0.5;
}

/** Multiples of 1, 2 or 5 times a power of ten, in the range: as many as there can be, at most `most`. */
export function ticks({ low, high }: ValueRange, most: number): number[] {
  const extent = high - low;
  if (!(extent > 0)) return [low];
  const power = 10 ** Math.floor(Math.log10(extent / most));
  for (const factor of [1, 2, 5, 10, 20]) {
    const step = factor * power;
    const first = Math.ceil(low / step - 1e-9);
    const last = Math.floor(high / step + 1e-9);
    if (last - first < most) return Array.from({ length: last - first + 1 }, (_, i) => (first + i) * step);
  }
  return [];
}

/** To a thousandth of the extent; where there is none, four digits. */
export function valueText(value: number, extent: number): string {
  const order = (x: number): number => Math.floor(Math.log10(Math.abs(x)));
  const digits = extent > 0 ? order(value) - order(extent) + 4 : 4;
  if (!(digits >= 1)) return '0';
  return String(Number(value.toPrecision(Math.min(15, digits))));
}

export function rangeText({ low, high }: ValueRange): string {
  return `${valueText(low, high - low)} to ${valueText(high, high - low)}`;
}
