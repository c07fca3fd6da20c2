// The messages between a page and the viewer in a frame of it, by postMessage. Both know the other's origin beforehand.
//
// The viewer begins, each time that it is loaded, with a number drawn at random. What the page answers carries it, and a number
// that rises: so nothing that was said before, to this viewer or to one before it, can be said again by another.
import { colorBy, isRange, longestUnit, readUnit, type ColorChoice, type ColorLook } from '../color/color_choice';
import { colorMapNames, isColorMap } from '../color/color_maps';
import { isSessionId, type PageState } from '../ui/link';

/** From the viewer: it listens. */
export interface Ready {
  readonly meniscus: 'ready';
  readonly nonce: string;
}

/** From the page: what to show, and the token to ask the server with. */
export interface Show {
  readonly meniscus: 'show';
  readonly nonce: string;
  /** Rises from message to message. */
  readonly number: number;
  /** UUID. */
  readonly session: string;
  /** World units; without one the camera keeps all of the water in view. */
  readonly camera?: { readonly position: readonly number[]; readonly target: readonly number[] };
  readonly look?: 'water' | 'levels';
  readonly up?: 'x' | 'y' | 'z';
  /** An attribute that the session's settings name, or a component of one, as "velocity.x". */
  readonly color?: string;
  /** The map of colors; without one viridis. */
  readonly map?: string;
  /** The range of each frame, that of the session so far, or two numbers; without one that of the session so far. */
  readonly range?: 'frame' | 'session' | readonly [number, number];
  /** Of the numbers, in the legend. */
  readonly unit?: string;
  /** Exactly the colors of the legend, without light. */
  readonly light?: 'off';
  /** Empty: none. */
  readonly token: string;
}

export interface HandedOver {
  readonly state: PageState;
  readonly token: string;
}

export function isReady(data: unknown): data is Ready {
  return isRecord(data) && data.meniscus === 'ready' && typeof data.nonce === 'string';
}

/** Whether it claims to be one: its content is still to be read. */
export function isShow(data: unknown): data is { readonly nonce: unknown; readonly number: unknown } {
  return isRecord(data) && data.meniscus === 'show';
}

/** Throws Error with a sentence where the page has handed over something that cannot be. */
export function readShow(data: unknown): HandedOver {
  const { session, camera, look, up, color, map, range, unit, light, token } = data as Record<string, unknown>;
  if (typeof session !== 'string' || !isSessionId(session)) throw wrong('session', session, 'a UUID');
  if (typeof token !== 'string' || !/^[\x21-\x7e]{0,4096}$/.test(token))
    // It is not shown: it may be a token with a slip in it.
    throw new Error(
      'The page around this viewer has handed over a token that is none: at most 4096 letters, digits and signs of ASCII.',
    );
  if (look !== undefined && look !== 'water' && look !== 'levels') throw wrong('look', look, '"water" or "levels"');
  if (up !== undefined && up !== 'x' && up !== 'y' && up !== 'z') throw wrong('up', up, '"x", "y" or "z"');
  const place = readCamera(camera);
  const choice = readColor(color, map, range, unit, light);
  return {
    state: {
      session,
      ...(place ? { camera: place } : {}),
      ...(look ? { look } : {}),
      ...(up ? { up } : {}),
      ...(choice ? { color: choice } : {}),
    },
    token,
  };
}

function readCamera(camera: unknown): PageState['camera'] {
  if (camera === undefined) return undefined;
  const { position, target } = isRecord(camera) ? camera : {};
  if (!isPoint(position) || !isPoint(target))
    throw wrong('camera', camera, '{position: [x, y, z], target: [x, y, z]}, finite numbers');
  return { position: [...position], target: [...target] };
}

function readColor(
  color: unknown,
  map: unknown,
  range: unknown,
  unit: unknown,
  light: unknown,
): ColorChoice | undefined {
  if (map !== undefined && (typeof map !== 'string' || !isColorMap(map)))
    throw wrong('map', map, `one of ${colorMapNames.join(', ')}`);
  if (range !== undefined && range !== 'frame' && range !== 'session' && !isRange(range))
    throw wrong('range', range, '"frame", "session" or [from, to], from less than to');
  const inUnit = unit === undefined ? '' : typeof unit === 'string' ? readUnit(unit) : undefined;
  if (inUnit === undefined) throw wrong('unit', unit, `text of at most ${longestUnit} characters`);
  if (light !== undefined && light !== 'off') throw wrong('light', light, '"off"');
  if (color === undefined) return undefined;
  const look: Partial<ColorLook> = {
    ...(map ? { map } : {}),
    ...(range ? { range } : {}),
    unit: inUnit,
    unlit: light === 'off',
  };
  const choice = typeof color === 'string' ? colorBy(color, look) : undefined;
  if (!choice) throw wrong('color', color, 'the name of an attribute, or of its component, as "velocity.x"');
  return choice;
}

function isPoint(value: unknown): value is [number, number, number] {
  return Array.isArray(value) && value.length === 3 && value.every(Number.isFinite);
}

function isRecord(value: unknown): value is Record<string, unknown> {
  return typeof value === 'object' && value !== null;
}

function wrong(name: string, value: unknown, allowed: string): Error {
  const text = value === undefined ? 'none' : JSON.stringify(value);
  return new Error(
    `The page around this viewer has handed over the ${name} ${text.slice(0, 80)}; it must be ${allowed}.`,
  );
}
