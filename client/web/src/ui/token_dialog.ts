// Asks for the token that the server wants; kept for this tab only.
import { element } from './page';

const storageKey = 'meniscus-token';

/** Empty: none. */
export function storedToken(): string {
  return storage()?.getItem(storageKey) ?? '';
}

/** another: whether there was one, which stays to be mended. Resolves with what was entered; with undefined when the dialog is closed without. */
export function askToken(another: boolean, reason: string): Promise<string | undefined> {
  const dialog = element('token-dialog', HTMLDialogElement);
  const input = element('token', HTMLInputElement);
  element('token-reason', HTMLElement).textContent = reason;
  element('token-heading', HTMLElement).textContent = another ? 'Another token is needed' : 'A token is needed';
  dialog.returnValue = '';
  if (!dialog.open) {
    dialog.showModal();
    input.select();
  }
  return new Promise((resolve) => {
    dialog.addEventListener(
      'close',
      () => {
        const token = input.value.trim();
        if (dialog.returnValue !== 'use' || token === '') {
          resolve(undefined);
          return;
        }
        storage()?.setItem(storageKey, token);
        resolve(token);
      },
      { once: true },
    );
  });
}

/** None where the browser keeps nothing for this page. */
function storage(): Storage | undefined {
  try {
    return sessionStorage;
  } catch {
    return undefined;
  }
}
