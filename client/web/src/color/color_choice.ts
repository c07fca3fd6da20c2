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
}

const firstMap: ColorMap = 'viridis';
const form = /^([a-z0-9_]{1,64})(?:\.([xyzw]))?$/;

/** Without a map it is viridis, without a range that of the session. None if the text names no attribute that can be. */
export function colorBy(
  text: string,
  map: ColorMap = firstMap,
  range: RangeChoice = 'session',
): ColorChoice | undefined {
  const [, attribute, component] = form.exec(text) ?? [];
  if (attribute === undefined) return undefined;
  return { attribute, ...(component === undefined ? {} : { component: component as ComponentName }), map, range };
}

/** NAME or NAME.COMPONENT. */
export function colorText({ attribute, component }: Pick<ColorChoice, 'attribute' | 'component'>): string {
  return component === undefined ? attribute : `${attribute}.${component}`;
}

/** A field that cannot be read is as if it were not there. */
export function readColorLink(fields: URLSearchParams): ColorChoice | undefined {
  const map = fields.get('map') ?? '';
  return colorBy(fields.get('color') ?? '', isColorMap(map) ? map : undefined, readRange(fields.get('range')));
}

export function writeColorLink(fields: URLSearchParams, choice: ColorChoice): void {
  fields.set('color', colorText(choice));
  if (choice.map !== firstMap) fields.set('map', choice.map);
  if (choice.range !== 'session')
    fields.set('range', typeof choice.range === 'string' ? choice.range : choice.range.join(','));
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
