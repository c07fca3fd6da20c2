import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { readEmbedding } from '../src/frame/embedding';
import { listenToPage } from '../src/frame/frame_guest';
import { showMeniscus, type MeniscusFrame } from '../src/frame/meniscus_frame';
import type { HandedOver } from '../src/frame/messages';

const page = 'https://page.example';
const viewer = 'https://water.example:9464';
const session = '01234567-89ab-cdef-0123-456789abcdef';
const other = '00000000-0000-4000-8000-000000000000';
const camera = { position: [1, 2, 3], target: [4, 5, 6] };

describe('the address of a viewer in a frame', () => {
  it('names the origin of the page around, or none', () => {
    expect(readEmbedding('')).toBeUndefined();
    expect(readEmbedding('?x=embed')).toBeUndefined();
    expect(readEmbedding('?embed')).toEqual({ page: undefined });
    expect(readEmbedding(`?embed=${encodeURIComponent(page)}`)).toEqual({ page });
    for (const none of [
      '*',
      'null',
      'https://page.example/',
      'https://page.example/x',
      'data:,x',
      'PAGE',
      'https://Page.example',
    ])
      expect(readEmbedding(`?embed=${encodeURIComponent(none)}`), none).toEqual({ page: undefined });
  });
});

describe('the viewer in a frame', () => {
  const parent = { postMessage: vi.fn() };
  let listener: (event: MessageEvent<unknown>) => void;
  let shown: HandedOver[];
  let refused: string[];

  beforeEach(() => {
    parent.postMessage.mockClear();
    shown = [];
    refused = [];
    const window = { parent, addEventListener: (_: string, listen: typeof listener) => (listener = listen) };
    listenToPage(window, page, 'nonce', {
      show: (handed) => shown.push(handed),
      refused: (reason) => refused.push(reason),
    });
  });

  const hear = (data: unknown, { origin = page, source = parent as unknown } = {}): void => {
    listener({ data, origin, source } as MessageEvent<unknown>);
  };
  const message = (changes = {}) => ({
    meniscus: 'show',
    nonce: 'nonce',
    number: 1,
    session,
    token: 'secret',
    ...changes,
  });

  it('says that it listens to the page of that origin alone', () => {
    expect(parent.postMessage.mock.calls).toEqual([[{ meniscus: 'ready', nonce: 'nonce' }, page]]);
  });

  it('takes session, camera and token', () => {
    hear(message({ camera, look: 'levels', up: 'z' }));
    expect(shown).toEqual([{ state: { session, camera, look: 'levels', up: 'z' }, token: 'secret' }]);
  });

  it('takes what the surface is colored by', () => {
    hear(message({ color: 'velocity.x', map: 'magma', range: [0, 5] }));
    hear(message({ number: 3, color: 'age', unit: 's', light: 'off' }));
    hear(message({ number: 4, map: 'magma' }));
    expect(shown.map(({ state }) => state.color)).toEqual([
      { attribute: 'velocity', component: 'x', map: 'magma', range: [0, 5], unit: '', unlit: false },
      { attribute: 'age', map: 'viridis', range: 'session', unit: 's', unlit: true },
      undefined,
    ]);
  });

  it('hears no other origin, no other window, and no other viewer’s messages', () => {
    for (const origin of ['https://page.example.evil', 'http://page.example', 'https://page.example:8443', 'null', ''])
      hear(message(), { origin });
    for (const source of [null, {}, { postMessage: vi.fn() }]) hear(message(), { source });
    for (const nonce of ['other', '', undefined, 0]) hear(message({ nonce }));
    for (const data of [null, undefined, 'show', 3, {}, [], { meniscus: 'ready', nonce: 'nonce' }]) hear(data);
    expect([shown, refused]).toEqual([[], []]);
  });

  it('does not obey again what is said again', () => {
    hear(message());
    hear(message({ number: 3, session: other }));
    hear(message());
    hear(message({ number: 3 }));
    for (const number of ['4', NaN, -1, undefined]) hear(message({ number }));
    expect(shown.map(({ state }) => state.session)).toEqual([session, other]);
  });

  it.each([
    ['session', { session: '../../etc' }],
    ['session', { session: undefined }],
    ['camera', { camera: { position: [1, 2], target: [0, 0, 0] } }],
    ['camera', { camera: { position: [1, 2, Infinity], target: [0, 0, 0] } }],
    ['camera', { camera: null }],
    ['look', { look: 'oil' }],
    ['up', { up: 'w' }],
    ['color', { color: 'Velocity' }],
    ['color', { color: 7 }],
    ['map', { color: 'age', map: 'jet' }],
    ['range', { color: 'age', range: [5, 0] }],
    ['range', { color: 'age', range: 'all' }],
    ['unit', { color: 'age', unit: 'metres per second' }],
    ['unit', { color: 'age', unit: 5 }],
    ['light', { color: 'age', light: true }],
    ['token', { token: 'a\r\nb' }],
    ['token', { token: 7 }],
  ])('refuses in words a %s that cannot be', (name, changes) => {
    hear(message(changes));
    expect(shown).toEqual([]);
    expect(refused).toHaveLength(1);
    expect(refused[0]).toContain(name);
    // Not even one with a slip in it is shown.
    if (name === 'token') expect(refused[0]).not.toContain('a\r');
  });
});

describe('the page around', () => {
  const frameWindow = { postMessage: vi.fn() };
  const attributes = new Map<string, string>();
  const iframe = {
    src: '',
    style: { display: '' },
    after: vi.fn(),
    contentWindow: frameWindow,
    setAttribute: (name: string, value: string) => attributes.set(name, value),
    remove: vi.fn(),
  };
  const sentence = { style: {}, textContent: '', setAttribute: () => undefined, remove: vi.fn() };
  const place = { replaceChildren: vi.fn() } as unknown as Element;
  let listener: ((event: MessageEvent<unknown>) => void) | undefined;
  let frame: MeniscusFrame;

  const warned = vi.spyOn(console, 'warn');

  beforeEach(() => {
    vi.useFakeTimers();
    warned.mockReset().mockImplementation(() => undefined);
    frameWindow.postMessage.mockClear();
    iframe.after.mockClear();
    vi.stubGlobal('location', { origin: page });
    vi.stubGlobal('document', { createElement: (name: string) => (name === 'iframe' ? iframe : sentence) });
    vi.stubGlobal('addEventListener', (_: string, listen: typeof listener) => (listener = listen));
    vi.stubGlobal('removeEventListener', () => (listener = undefined));
    frame = showMeniscus(place, `${viewer}/x?y`, { session, camera, token: 'secret' });
  });
  afterEach(() => {
    frame.remove();
    vi.unstubAllGlobals();
    vi.useRealTimers();
  });

  const hear = (nonce: string, { origin = viewer, source = frameWindow as unknown } = {}): void => {
    listener?.({ data: { meniscus: 'ready', nonce }, origin, source } as MessageEvent<unknown>);
  };
  const posted = (): unknown[] => frameWindow.postMessage.mock.calls;

  it('writes neither session nor token into the address', () => {
    expect(iframe.src).toBe(`${viewer}/?embed=${encodeURIComponent(page)}`);
    expect(attributes.get('sandbox')).toBe('allow-scripts allow-same-origin');
  });

  it('hands them to the viewer that says it listens, and to its origin alone', async () => {
    expect(posted()).toEqual([]);
    hear('one');
    await frame.ready;
    const message = { meniscus: 'show', nonce: 'one', number: 1, session, camera, token: 'secret' };
    expect(posted()).toEqual([[message, viewer]]);
    frame.show({ session: other });
    expect(posted()[1]).toEqual([{ meniscus: 'show', nonce: 'one', number: 2, session: other, token: '' }, viewer]);
    frame.show({ session: other, color: 'velocity', map: 'magma', range: 'frame', unit: 'm/s', light: 'off' });
    expect(posted()[2]).toMatchObject([
      { number: 3, color: 'velocity', map: 'magma', range: 'frame', unit: 'm/s', light: 'off' },
      viewer,
    ]);
    // Loaded again.
    hear('two');
    expect(posted()[3]).toMatchObject([{ nonce: 'two', number: 4, session: other }, viewer]);
  });

  it('answers no other origin and no other window', () => {
    for (const origin of ['https://water.example', 'https://evil.example', 'null']) hear('one', { origin });
    for (const source of [null, {}]) hear('one', { source });
    expect(posted()).toEqual([]);
  });

  it('warns a page that waits for nothing, without an error that nobody handles', async () => {
    const unhandled = vi.fn();
    process.on('unhandledRejection', unhandled);
    await vi.advanceTimersByTimeAsync(10_000);
    vi.useRealTimers();
    // Node reports it once no promise has anything left to do.
    await new Promise((resolve) => setTimeout(resolve, 0));
    process.off('unhandledRejection', unhandled);
    expect(unhandled).not.toHaveBeenCalled();
    expect(warned).toHaveBeenCalledExactlyOnceWith(expect.stringContaining('--web-frame-ancestors'));
  });

  it('says what to do where the viewer does not answer, and nothing once it is gone', async () => {
    const failure = frame.ready.catch((error: unknown) => String(error));
    await vi.advanceTimersByTimeAsync(10_000);
    expect(await failure).toContain(`--web-frame-ancestors ${page}`);
    expect(iframe.after).toHaveBeenCalledExactlyOnceWith(sentence);
    expect(sentence.textContent).toContain(`--web-frame-ancestors ${page}`);
    expect(iframe.style.display).toBe('none');
    // A viewer that comes late takes its place.
    hear('late');
    expect(sentence.remove).toHaveBeenCalled();
    expect(iframe.style.display).toBe('block');
    frame.remove();
    expect(listener).toBeUndefined();
    expect(iframe.remove).toHaveBeenCalled();
  });
});
