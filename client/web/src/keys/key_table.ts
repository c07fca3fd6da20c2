// The keys and their actions. The handler, the list of keys and the buttons' hints are made from these rows. A new one presses a button,
// and needs nothing else; or it names an action of its own, which goes into the record that the Keyboard is given.

interface KeyOf {
  /** Values of KeyboardEvent.key, letters in lower case. The action gets the one that was pressed. */
  readonly keys: readonly string[];
  /** With Shift, which otherwise is not held: of keys that are named and of letters. Shift is a part of other characters. */
  readonly shift?: boolean;
  /** As people read them. */
  readonly shown: string;
  readonly words: string;
  /** Whether it is done again and again while the key is held. */
  readonly repeats?: boolean;
  /** Whether it is done where nothing is looked at, too. */
  readonly everywhere?: boolean;
  /** Whether it opens a panel over the picture: a viewer in a frame of another page has none. */
  readonly panel?: boolean;
}

/** button: the id of the one that is pressed. */
export type KeyRow = KeyOf & ({ readonly button: string } | { readonly action: string });

const arrows = ['ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown'] as const;

export const keyTable = [
  { action: 'turn', keys: arrows, shown: 'Arrows', words: 'turn the camera', repeats: true },
  { action: 'shift', keys: arrows, shift: true, shown: 'Shift and arrows', words: 'shift it', repeats: true },
  { action: 'zoom', keys: ['+', '=', '-'], shown: 'Plus, minus', words: 'zoom', repeats: true },
  { button: 'fit', keys: ['f'], shown: 'F', words: 'follow the water' },
  { button: 'look', keys: ['w'], shown: 'W', words: 'water or wires' },
  { button: 'show-particles', keys: ['p'], shown: 'P', words: 'particles in place of the surface' },
  { button: 'view-x', keys: ['x'], shown: 'X', words: 'look along X; again: from the other side' },
  { button: 'view-y', keys: ['y'], shown: 'Y', words: 'look along Y' },
  { button: 'view-z', keys: ['z'], shown: 'Z', words: 'look along Z' },
  { button: 'scale', keys: ['s'], shown: 'S', words: 'scale bar and axes' },
  { button: 'color', keys: ['a'], shown: 'A', words: 'color by an attribute', panel: true },
  { button: 'cut', keys: ['c'], shown: 'C', words: 'cut through the water', panel: true },
  { button: 'probe', keys: ['i'], shown: 'I', words: 'place, level and value under the pointer', panel: true },
  { button: 'ruler', keys: ['r'], shown: 'R', words: 'distance between two points', panel: true },
  { button: 'picture', keys: ['g'], shown: 'G', words: 'save a picture' },
  { button: 'pause', keys: [' '], shown: 'Space', words: 'pause, and go on' },
  { button: 'back', keys: [','], shown: 'Comma', words: 'one frame back', repeats: true },
  { button: 'forward', keys: ['.'], shown: 'Period', words: 'one frame forward', repeats: true },
  { button: 'measure', keys: ['m'], shown: 'M', words: 'show or hide the figures', panel: true },
  { button: 'show-keys', keys: ['?'], shown: '?', words: 'show these keys', everywhere: true },
] as const satisfies readonly KeyRow[];

/** embedded: whether the viewer is to show the water alone. */
export function keysOf(embedded: boolean): readonly (typeof keyTable)[number][] {
  return embedded ? keyTable.filter((row) => !('panel' in row)) : keyTable;
}

/** The actions of a table that no button does. */
export type ActionOf<Row> = Row extends { readonly action: infer Name extends string } ? Name : never;

export interface KeyPress {
  readonly key: string;
  readonly shiftKey: boolean;
  readonly repeat: boolean;
}

/** The row of the key that was pressed, with the key as the row names it. */
export function rowOf<Row extends KeyRow>(
  table: readonly Row[],
  press: KeyPress,
): { row: Row; key: string } | undefined {
  const { key, letter } = named(press.key);
  const shiftCounts = letter || key.length > 1 || key === ' ';
  const row = table.find(
    ({ keys, shift, repeats }) =>
      keys.includes(key) &&
      (!shiftCounts || (shift ?? false) === press.shiftKey) &&
      (repeats === true || !press.repeat),
  );
  return row && { row, key };
}

/** Caps Lock makes no other key of a letter. */
function named(key: string): { key: string; letter: boolean } {
  const letter = key.length === 1 && key.toLowerCase() !== key.toUpperCase();
  return { key: letter ? key.toLowerCase() : key, letter };
}
