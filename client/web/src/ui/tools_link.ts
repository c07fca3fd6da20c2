// The state of the tools in the link.
import type { Point } from '../view/bounds';
import type { Cut } from '../view/cut';
import { readColorLink, writeColorLink, type ColorChoice } from '../color/color_choice';
import { isAxis } from '../view/up_axis';
import { sessionForm } from './session_form';

export interface ToolsState {
  readonly cut?: Cut;
  /** Both ends. */
  readonly ruler?: readonly [Point, Point];
  /** The session that is shown beside. */
  readonly beside?: string;
  /** Without scale bar and axes. */
  readonly scale?: 'off';
  /** Without the domain's box. */
  readonly domain?: 'off';
  /** The quantity of the surface's colors. */
  readonly color?: ColorChoice;
}

/** Fields that cannot be read are left out. */
export function readToolsLink(fields: URLSearchParams): ToolsState {
  const cut = readCut(fields.get('cut'));
  const ruler = numbers(fields.get('ruler'));
  const beside = fields.get('beside');
  const color = readColorLink(fields);
  return {
    ...(cut ? { cut } : {}),
    ...(ruler?.length === 6 ? { ruler: [ruler.slice(0, 3) as Point, ruler.slice(3) as Point] as const } : {}),
    ...(beside !== null && sessionForm.test(beside) ? { beside } : {}),
    ...(fields.get('scale') === 'off' ? { scale: 'off' as const } : {}),
    ...(fields.get('domain') === 'off' ? { domain: 'off' as const } : {}),
    ...(color ? { color } : {}),
  };
}

export function writeToolsLink(
  fields: URLSearchParams,
  { cut, ruler, beside, scale, domain, color }: ToolsState,
): void {
  if (cut) fields.set('cut', `${cut.axis},${linkNumber(cut.at)},${cut.away}`);
  if (ruler) fields.set('ruler', ruler.flat().map(linkNumber).join(','));
  if (beside !== undefined) fields.set('beside', beside);
  if (scale) fields.set('scale', scale);
  if (domain) fields.set('domain', domain);
  if (color) writeColorLink(fields, color);
}

function readCut(text: string | null): Cut | undefined {
  const [axis = '', place = '', away] = (text ?? '').split(',');
  const at = place === '' ? NaN : Number(place);
  if (!isAxis(axis) || !Number.isFinite(at) || (away !== 'beyond' && away !== 'before')) return undefined;
  return { axis, at, away };
}

/** Separated by commas; none if one of them is not a number. */
export function numbers(text: string | null): number[] | undefined {
  const read = (text ?? '').split(',').map((x) => (x === '' ? NaN : Number(x)));
  return read.every(Number.isFinite) ? read : undefined;
}

/** The number, rounded to nine digits. */
export function linkNumber(x: number): number {
  return Number(x.toPrecision(9));
}
