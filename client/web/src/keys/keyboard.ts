// Keys act wherever the focus is, but for those that belong to what has it.
import { rowOf, type ActionOf, type KeyRow } from './key_table';
import { ownsKey, type Focused } from './key_owner';

export type Actions<Name extends string> = Readonly<Record<Name, (key: string) => void>>;

export interface KeyboardPage {
  press(button: string): void;
  /** Whether a session or a recording is looked at. */
  looking(): boolean;
  /** Whether a dialog is open, which has all keys. */
  dialogOpen(): boolean;
}

/** The part of the page that is needed. */
export interface KeyTarget {
  addEventListener(type: string, listener: (event: Event) => void, capture: boolean): void;
}

export class Keyboard<Row extends KeyRow> {
  /** The control that a pointer has pressed, until Tab moves the focus: also after a dialog that gives the focus back. */
  private pointed: EventTarget | null = null;
  /** Space, of which a button would take the release for a press. */
  private taken: string | undefined;

  constructor(
    target: KeyTarget,
    private readonly table: readonly Row[],
    private readonly actions: Actions<ActionOf<Row>>,
    private readonly page: KeyboardPage,
  ) {
    target.addEventListener('pointerdown', (event) => (this.pointed = controlOf(event.target)), true);
    target.addEventListener(
      'keydown',
      (event) => {
        this.down(event as KeyboardEvent);
      },
      true,
    );
    target.addEventListener(
      'keyup',
      (event) => {
        if ((event as KeyboardEvent).key === this.taken) event.preventDefault();
        this.taken = undefined;
      },
      true,
    );
  }

  private down(event: KeyboardEvent): void {
    if (event.key === 'Tab') this.pointed = null;
    if (event.defaultPrevented || event.isComposing || event.ctrlKey || event.metaKey || event.altKey) return;
    if (this.page.dialogOpen()) return;
    const focused = event.target as (Focused & EventTarget) | null;
    if (focused && ownsKey(focused, event.key, focused === this.pointed)) return;
    const found = rowOf(this.table, event);
    if (!found) {
      // The repeats of a key that is held: the button must not do its action once more.
      if (event.repeat && event.key === this.taken) event.preventDefault();
      return;
    }
    const { row, key } = found;
    if (!row.everywhere && !this.page.looking()) return;
    event.preventDefault();
    this.taken = event.key;
    if ('button' in row) this.page.press(row.button);
    else this.actions[row.action as ActionOf<Row>](key);
  }
}

/** The control, which has the focus, around an element that was clicked. */
function controlOf(target: EventTarget | null): EventTarget | null {
  const element = target as (EventTarget & { closest?: (selector: string) => Element | null }) | null;
  return element?.closest?.('button, summary, a, input, textarea, select, [tabindex]') ?? target;
}
