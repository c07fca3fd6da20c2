// For pages of others: shows the water of a session in a frame. Built to meniscus-frame.js, which stands alone: copy it beside your
// page. The server must list the page's origin (meniscusd --web-frame-ancestors).
import { isReady, type Show } from './messages';

export interface View {
  /** UUID of the session. */
  readonly session: string;
  /** World units; without one all of the water is kept in view. */
  readonly camera?: { readonly position: readonly number[]; readonly target: readonly number[] };
  readonly look?: 'water' | 'levels';
  /** Without one: as the session says. */
  readonly up?: 'x' | 'y' | 'z';
  /** An attribute that the session's settings name, or a component of one: "velocity", "velocity.x". Without one: water. */
  readonly color?: string;
  readonly map?: 'viridis' | 'magma' | 'plasma' | 'cividis' | 'coolwarm';
  /** The values at the ends of the map: without it the least and the greatest of the session so far. */
  readonly range?: 'frame' | 'session' | readonly [number, number];
  /** Of the numbers, for the legend, as "m/s": at most 16 characters. */
  readonly unit?: string;
  /** Exactly the colors of the legend, without the light that shows the shape. */
  readonly light?: 'off';
  /** Where the server asks for one: of the role watcher, since every script of the page can read it. */
  readonly token?: string;
}

export interface MeniscusFrame {
  readonly element: HTMLIFrameElement;
  /** Resolves when the viewer listens; rejects when it has not within ten seconds: then a sentence is in place of the frame, and on the console. */
  readonly ready: Promise<void>;
  /** Another session, camera or token; what is left out is as at the beginning. */
  show(view: View): void;
  /** Takes the frame away. */
  remove(): void;
}

/** ms */
const patience = 10_000;

/** Fills `place` with the frame. server: where the viewer is, as "https://water.example:9464". */
export function showMeniscus(place: Element, server: string, view: View): MeniscusFrame {
  const viewer = new URL(server).origin;
  if (location.origin === 'null')
    throw new Error('This page has no origin (it is a file, or in a sandbox): serve it from one that meniscusd lists.');
  const element = document.createElement('iframe');
  element.title = 'Simulated water';
  element.referrerPolicy = 'no-referrer';
  // The viewer's own origin, and nothing that reaches out of the frame.
  element.setAttribute('sandbox', 'allow-scripts allow-same-origin');
  element.style.cssText = 'display: block; width: 100%; height: 100%; border: 0';
  let shown = view;
  let nonce: string | undefined;
  let number = 0;
  let listens: () => void;
  const listening = new Promise<void>((resolve) => (listens = resolve));

  const handOver = (): void => {
    if (nonce === undefined) return;
    const { session, camera, look, up, color, map, range, unit, light, token = '' } = shown;
    const message: Show = {
      meniscus: 'show',
      nonce,
      number: ++number,
      session,
      ...(camera ? { camera } : {}),
      ...(look ? { look } : {}),
      ...(up ? { up } : {}),
      ...(color === undefined ? {} : { color }),
      ...(map ? { map } : {}),
      ...(range ? { range } : {}),
      ...(unit === undefined ? {} : { unit }),
      ...(light ? { light } : {}),
      token,
    };
    // Whatever else the frame may hold by now does not hear it.
    element.contentWindow?.postMessage(message, viewer);
  };
  const listen = ({ data, origin, source }: MessageEvent<unknown>): void => {
    if (origin !== viewer || source !== element.contentWindow || !isReady(data)) return;
    nonce = data.nonce;
    // Also one that comes late.
    problem.remove();
    element.style.display = 'block';
    listens();
    handOver();
  };
  addEventListener('message', listen);
  // In place of the browser's own page, which says that something is broken and not what.
  const problem = document.createElement('p');
  problem.setAttribute('role', 'alert');
  problem.style.cssText = 'margin: 0; padding: 1em; overflow-wrap: anywhere';
  let timer: ReturnType<typeof setTimeout>;
  const late = new Promise<void>((_, reject) => {
    timer = setTimeout(() => {
      reject(
        new Error(
          `The viewer of ${viewer} has not answered within ${patience / 1000} s: is the server there, and does it list this page (meniscusd --web-frame-ancestors ${location.origin})?`,
        ),
      );
    }, patience);
  });
  const ready = Promise.race([listening, late]).finally(() => {
    clearTimeout(timer);
  });
  // A page that does not wait for `ready` gets a warning, not an error without a handler.
  ready.catch((error: unknown) => {
    problem.textContent = error instanceof Error ? error.message : String(error);
    console.warn(problem.textContent);
    element.style.display = 'none';
    element.after(problem);
  });
  element.src = `${viewer}/?embed=${encodeURIComponent(location.origin)}`;
  place.replaceChildren(element);
  return {
    element,
    ready,
    show: (next) => {
      shown = next;
      handOver();
    },
    remove: () => {
      removeEventListener('message', listen);
      clearTimeout(timer);
      element.remove();
      problem.remove();
    },
  };
}
