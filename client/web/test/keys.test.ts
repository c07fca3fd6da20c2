import { beforeEach, describe, expect, it } from 'vitest';
import { ownsKey } from '../src/keys/key_owner';
import { keysOf, keyTable, rowOf, type ActionOf, type KeyRow } from '../src/keys/key_table';
import { Keyboard } from '../src/keys/keyboard';

const rowWith = (row: KeyRow): string => ('button' in row ? row.button : row.action);
const press = (key: string, held: { shiftKey?: boolean; repeat?: boolean } = {}) => ({
  key,
  shiftKey: false,
  repeat: false,
  ...held,
});
/** The action of the key, by its row. */
const does = (key: string, held = {}): string | undefined => {
  const found = rowOf<KeyRow>(keyTable, press(key, held));
  return found && rowWith(found.row);
};

describe('the table of keys', () => {
  it('has one row for each key, with words for it', () => {
    const keys = (keyTable as readonly KeyRow[]).flatMap((row) =>
      row.keys.map((key) => `${row.shift ? 'Shift ' : ''}${key}`),
    );
    expect(new Set(keys).size).toBe(keys.length);
    for (const { shown, words } of keyTable) expect(Math.min(shown.length, words.length)).toBeGreaterThan(0);
  });

  it('finds a key whatever Caps Lock, and with Shift another than without', () => {
    expect([does('f'), does('F'), does('F', { shiftKey: true })]).toEqual(['fit', 'fit', undefined]);
    expect([does('ArrowLeft'), does('ArrowLeft', { shiftKey: true })]).toEqual(['turn', 'shift']);
    expect([does('?'), does('?', { shiftKey: true })]).toEqual(['show-keys', 'show-keys']);
    expect([does('+', { shiftKey: true }), does('+')]).toEqual(['zoom', 'zoom']);
    expect([does(' '), does(' ', { shiftKey: true })]).toEqual(['pause', undefined]);
    expect([does('q'), does('Enter'), does('Tab'), does('Escape')]).toEqual([
      undefined,
      undefined,
      undefined,
      undefined,
    ]);
  });

  it('opens no panels where the water is shown alone', () => {
    const embedded = (key: string): string | undefined => {
      const found = rowOf<KeyRow>(keysOf(true), press(key));
      return found && rowWith(found.row);
    };
    expect(['c', 'i', 'r', 'm'].map(embedded)).toEqual([undefined, undefined, undefined, undefined]);
    expect(['f', ' ', 'x', '?'].map(embedded)).toEqual(['fit', 'pause', 'view-x', 'show-keys']);
    expect(keysOf(false)).toBe(keyTable);
  });

  it('repeats what is held where that is of use', () => {
    expect([does('ArrowUp', { repeat: true }), does(',', { repeat: true })]).toEqual(['turn', 'back']);
    expect([does(' ', { repeat: true }), does('w', { repeat: true })]).toEqual([undefined, undefined]);
  });
});

const flat = { scrollHeight: 10, clientHeight: 10 };
const input = (type: string) => ({ ...flat, tagName: 'INPUT', type });
const button = { ...flat, tagName: 'BUTTON' };

describe('a key belongs to', () => {
  it.each([
    ['a field', input('text'), ['a', ' ', 'ArrowLeft', '?', 'Enter'], []],
    ['a field of search', input('search'), ['a', ' ', '?'], []],
    ['a field of more lines', { ...flat, tagName: 'TEXTAREA' }, ['a', ' ', 'ArrowUp'], []],
    ['a text that can be edited', { ...flat, tagName: 'DIV', isContentEditable: true }, ['a', ' '], []],
    ['a choice', { ...flat, tagName: 'SELECT' }, ['a', 'ArrowUp'], []],
    ['a slider, its arrows', input('range'), ['ArrowLeft', 'ArrowUp', 'Home', 'PageDown'], [' ', 'f', '?', ',', '+']],
    ['a button', button, [' ', 'Enter'], ['f', 'ArrowLeft', '?']],
    ['a box to tick', input('checkbox'), [' '], ['f', 'ArrowLeft']],
    ['a link', { ...flat, tagName: 'A' }, ['Enter'], [' ', 'f', 'ArrowLeft']],
    [
      'what scrolls',
      { tagName: 'ASIDE', scrollHeight: 20, clientHeight: 10 },
      ['ArrowDown', 'End'],
      [' ', 'ArrowLeft'],
    ],
    ['nothing else', { ...flat, tagName: 'CANVAS' }, [], ['ArrowDown', ' ', 'Enter', 'f']],
  ])('%s', (_, focused, own, free) => {
    for (const key of own) expect(ownsKey(focused, key, false), key).toBe(true);
    for (const key of free) expect(ownsKey(focused, key, false), key).toBe(false);
  });

  it('a button that a pointer has pressed, but for Space', () => {
    expect([ownsKey(button, ' ', true), ownsKey(button, 'Enter', true)]).toEqual([false, true]);
    expect(ownsKey(input('text'), ' ', true)).toBe(true);
  });
});

describe('the keyboard', () => {
  const listeners = new Map<string, (event: Event) => void>();
  const target = {
    addEventListener: (type: string, listener: (event: Event) => void) => void listeners.set(type, listener),
  };
  let done: string[];
  let page: { looking: boolean; dialog: boolean };

  beforeEach(() => {
    done = [];
    page = { looking: true, dialog: false };
    const note = (name: string) => (key: string) => void done.push(`${name} ${key}`);
    const actions: Record<ActionOf<(typeof keyTable)[number]>, (key: string) => void> = {
      turn: note('turn'),
      shift: note('shift'),
      zoom: note('zoom'),
    };
    new Keyboard(target, keyTable, actions, {
      press: (id) => done.push(id),
      looking: () => page.looking,
      dialogOpen: () => page.dialog,
    });
  });

  /** Whether the page has taken it from the element. */
  function send(type: string, key: string, on: object, held = {}): boolean {
    let prevented = false;
    const event = {
      ...press(key),
      target: on,
      defaultPrevented: false,
      isComposing: false,
      ctrlKey: false,
      metaKey: false,
      altKey: false,
      preventDefault: () => (prevented = true),
      ...held,
    };
    listeners.get(type)!(event as unknown as Event);
    return prevented;
  }
  const point = (on: object): void => {
    listeners.get('pointerdown')!({ target: on } as Event);
  };
  const body = { ...flat, tagName: 'BODY' };

  it('acts wherever the focus is, and hands an action its key', () => {
    for (const on of [body, { ...flat, tagName: 'CANVAS' }, button, input('range')]) send('keydown', 'f', on);
    send('keydown', 'ArrowLeft', button);
    send('keydown', 'ArrowLeft', input('range'));
    send('keydown', 'f', input('text'));
    expect(done).toEqual(['fit', 'fit', 'fit', 'fit', 'turn ArrowLeft']);
  });

  it('pauses by Space after a click, and presses what Tab has reached', () => {
    point(button);
    expect(send('keydown', ' ', button)).toBe(true);
    // Firefox presses at the release.
    expect(send('keyup', ' ', button)).toBe(true);
    expect(done).toEqual(['pause']);
    send('keydown', 'Tab', button);
    expect(send('keydown', ' ', button)).toBe(false);
    expect(send('keyup', ' ', button)).toBe(false);
    expect(done).toEqual(['pause']);
  });

  it('pauses once for a Space that is held, and presses nothing meanwhile', () => {
    point(button);
    send('keydown', ' ', button);
    expect(send('keydown', ' ', button, { repeat: true })).toBe(true);
    expect(done).toEqual(['pause']);
  });

  it('leaves keys to the browser, to dialogs and to input methods', () => {
    for (const held of [
      { ctrlKey: true },
      { metaKey: true },
      { altKey: true },
      { isComposing: true },
      { defaultPrevented: true },
    ])
      expect(send('keydown', 'f', body, held)).toBe(false);
    page.dialog = true;
    expect(send('keydown', ' ', body)).toBe(false);
    expect(done).toEqual([]);
  });

  it('shows the keys beside the list, where the others do nothing', () => {
    page.looking = false;
    for (const key of [' ', 'f', 'ArrowLeft', '?']) send('keydown', key, body);
    expect(done).toEqual(['show-keys']);
  });
});
