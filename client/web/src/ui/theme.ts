// Dark or light: as the system has it, until the person chooses.
import type { Theme } from '../view/environment';
import { element } from './page';

export function followTheme(apply: (theme: Theme) => void): void {
  const dark = matchMedia('(prefers-color-scheme: dark)');
  let chosen: Theme | undefined;
  const current = (): Theme => chosen ?? (dark.matches ? 'dark' : 'light');
  const update = (): void => {
    document.documentElement.dataset.theme = current();
    apply(current());
  };
  dark.addEventListener('change', update);
  element('theme', HTMLButtonElement).addEventListener('click', () => {
    chosen = current() === 'dark' ? 'light' : 'dark';
    update();
  });
  update();
}
