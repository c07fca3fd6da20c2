// The keys, as a list; and each as a hint on the button that does the same.
import type { KeyRow } from '../keys/key_table';
import { element } from './page';

export class KeysDialog {
  private readonly dialog = element('keys-dialog', HTMLDialogElement);

  constructor(table: readonly KeyRow[]) {
    const list = element('keys', HTMLDListElement);
    for (const row of table) {
      const keys = document.createElement('dt');
      const words = document.createElement('dd');
      keys.textContent = row.shown;
      words.textContent = row.words;
      const line = document.createElement('div');
      line.append(keys, words);
      list.append(line);
      if ('button' in row) element(row.button, HTMLButtonElement).title = `${capital(row.words)} (${row.shown})`;
    }
    element('show-keys', HTMLButtonElement).addEventListener('click', () => {
      this.dialog.showModal();
    });
    // The key that opens it closes it, too.
    this.dialog.addEventListener('keydown', (event) => {
      if (event.key === '?') this.dialog.close();
    });
  }
}

function capital(words: string): string {
  return words.charAt(0).toUpperCase() + words.slice(1);
}
