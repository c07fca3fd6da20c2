// The field that narrows the lists.
import { element } from './page';

/** changed: whenever another text is searched for. */
export function followSearch(changed: () => void): void {
  element('search', HTMLInputElement).addEventListener('input', changed);
}

export function searched(): string {
  return element('search', HTMLInputElement).value;
}
