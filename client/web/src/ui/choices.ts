// A list of buttons to choose from: a name and, below it, what there is to say of it.
import { arrange } from './arrange';

export interface Choice {
  readonly name: string;
  /** The title for people; empty: its name alone. */
  readonly title: string;
  readonly about: string;
  chosen(): void;
}

/** Entries that stay keep their buttons, and with them the keyboard's focus. `key` names the buttons' data attribute. */
export function showChoices(list: HTMLUListElement, key: string, choices: Choice[]): void {
  const buttons = new Map([...list.querySelectorAll('button')].map((button) => [button.dataset[key], button]));
  arrange(
    list,
    choices.map((choice) => {
      const button = buttons.get(choice.name) ?? makeButton(key, choice);
      button.querySelector('.about')!.textContent = choice.about;
      return button.parentElement!;
    }),
  );
}

function makeButton(key: string, choice: Choice): HTMLButtonElement {
  const button = document.createElement('button');
  button.type = 'button';
  button.dataset[key] = choice.name;
  const title = document.createElement('bdi');
  title.className = 'name';
  title.textContent = choice.title;
  title.hidden = choice.title === '';
  const name = document.createElement('code');
  name.textContent = choice.name;
  const heading = document.createElement('span');
  heading.className = 'heading';
  heading.append(title, name);
  const about = document.createElement('span');
  about.className = 'about';
  button.append(heading, about);
  button.addEventListener('click', () => {
    choice.chosen();
  });
  document.createElement('li').append(button);
  return button;
}
