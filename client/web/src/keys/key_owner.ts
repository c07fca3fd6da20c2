// Whether a key belongs to what has the focus: what is typed into a field, or would move a slider, is not for the page.

/** The parts of an element that decide. */
export interface Focused {
  readonly tagName: string;
  /** The type of an input. */
  readonly type?: string;
  readonly isContentEditable?: boolean;
  readonly scrollHeight: number;
  readonly clientHeight: number;
}

const sliding = new Set(['ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown', 'Home', 'End', 'PageUp', 'PageDown']);
const scrolling = new Set(['ArrowUp', 'ArrowDown', 'Home', 'End', 'PageUp', 'PageDown']);
const pressing = new Set([' ', 'Enter']);

/** byPointer: whether a pointer has put the focus there. Then Space is not meant for it. */
export function ownsKey(focused: Focused, key: string, byPointer: boolean): boolean {
  switch (focused.tagName) {
    case 'TEXTAREA':
    case 'SELECT':
      return true;
    case 'INPUT':
      return inputOwns(focused.type ?? 'text', key, byPointer);
    case 'BUTTON':
    case 'SUMMARY':
      return pressing.has(key) && !(byPointer && key === ' ');
    case 'A':
      return key === 'Enter';
    default:
      if (focused.isContentEditable === true) return true;
      return focused.scrollHeight > focused.clientHeight && !byPointer && scrolling.has(key);
  }
}

function inputOwns(type: string, key: string, byPointer: boolean): boolean {
  switch (type) {
    case 'range':
      return sliding.has(key);
    case 'radio':
      return sliding.has(key) || (pressing.has(key) && !byPointer);
    case 'checkbox':
    case 'button':
    case 'submit':
    case 'reset':
      return pressing.has(key) && !(byPointer && key === ' ');
    default:
      return true;
  }
}
