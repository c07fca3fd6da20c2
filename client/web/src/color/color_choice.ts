// A person's choice of a quantity to color by, and its form in the link.
import { isColorMap, type ColorMap } from './color_maps';

export const componentNames = ['x', 'y', 'z', 'w'] as const;
export type ComponentName = (typeof componentNames)[number];

/** The range of each frame; that of all frames seen of the session or the recording; or by hand: the lower end, then the upper one. */
export type RangeChoice = 'frame' | 'session' | readonly [number, number];

export interface ColorChoice {
  readonly attribute: string;
  /** None: the number itself; of a vector its magnitude. */
  readonly component?: ComponentName;
  readonly map: ColorMap;
  readonly range: RangeChoice;
  /** Of the numbers, in the legend; empty: none is known. */
  readonly unit: string;
  /** Whether the surface has exactly the colors of the legend, and no light that shows its shape. */
  readonly unlit: boolean;
}

/** A choice, but for what it is of. */
export type ColorLook = Omit<ColorChoice, 'attribute' | 'component'>;

/** Characters of a unit. */
export const longestUnit = 16;
const firstMap: ColorMap = 'viridis';
const form = /^([a-z0-9_]{1,64})(?:\.([xyzw]))?$/;

/** Without a map it is viridis, without a range that of the session. None if the text names no attribute that can be. */
export function colorBy(
  text: string,
  { map = firstMap, range = 'session', unit = '', unlit = false }: Partial<ColorLook> = {},
): ColorChoice | undefined {
  const [, attribute, component] = form.exec(text) ?? [];
  if (attribute === undefined) return undefined;
  const look = { map, range, unit, unlit };
  return { attribute, ...(component === undefined ? {} : { component: component as ComponentName }), ...look };
}

/** NAME or NAME.COMPONENT. */
export function colorText({ attribute, component }: Pick<ColorChoice, 'attribute' | 'component'>): string {
  return component === undefined ? attribute : `${attribute}.${component}`;
}

/** A field that cannot be read is as if it were not there. */
export function readColorLink(fields: URLSearchParams): ColorChoice | undefined {
  const map = fields.get('map') ?? '';
  const range = readRange(fields.get('range'));
  return colorBy(fields.get('color') ?? '', {
    ...(isColorMap(map) ? { map } : {}),
    ...(range ? { range } : {}),
    unit: readUnit(fields.get('unit') ?? '') ?? '',
    unlit: fields.get('light') === 'off',
  });
}

export function writeColorLink(fields: URLSearchParams, choice: ColorChoice): void {
  fields.set('color', colorText(choice));
  if (choice.map !== firstMap) fields.set('map', choice.map);
  if (choice.range !== 'session')
    fields.set('range', typeof choice.range === 'string' ? choice.range : choice.range.join(','));
  if (choice.unit !== '') fields.set('unit', choice.unit);
  if (choice.unlit) fields.set('light', 'off');
}

/** None where it is too long, or has characters that cannot be seen. */
export function readUnit(text: string): string | undefined {
  const unit = text.trim();
  return unit.length <= longestUnit && !/[\p{C}\p{Zl}\p{Zp}]/u.test(unit) ? unit : undefined;
}

export function isRange(value: unknown): value is readonly [number, number] {
  return (
    Array.isArray(value) &&
    value.length === 2 &&
    value.every(Number.isFinite) &&
    (value as [number, number])[0] < (value as [number, number])[1]
  );
}

function readRange(text: string | null): RangeChoice | undefined {
  if (text === 'frame' || text === 'session') return text;
  const ends = (text ?? '').split(',').map((end) => (end === '' ? NaN : Number(end)));
  return isRange(ends) ? ends : undefined;
}
