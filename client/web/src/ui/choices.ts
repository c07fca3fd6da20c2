// A list of buttons to choose from: a name and, below it, what there is to say of it.

export interface Choice {
  readonly name: string;
  readonly about: string;
  chosen(): void;
}

/** Entries that stay keep their buttons, and with them the keyboard's focus. `key` names the buttons' data attribute. */
export function showChoices(list: HTMLUListElement, key: string, choices: Choice[]): void {
  const buttons = new Map([...list.querySelectorAll('button')].map((button) => [button.dataset[key], button]));
  list.replaceChildren(
    ...choices.map((choice) => {
      const button = buttons.get(choice.name) ?? makeButton(key, choice);
      button.querySelector('.about')!.textContent = choice.about;
      const item = document.createElement('li');
      item.append(button);
      return item;
    }),
  );
}

function makeButton(key: string, choice: Choice): HTMLButtonElement {
  const button = document.createElement('button');
  button.type = 'button';
  button.dataset[key] = choice.name;
  const name = document.createElement('code');
  name.textContent = choice.name;
  const about = document.createElement('span');
  about.className = 'about';
  button.append(name, about);
  button.addEventListener('click', () => {
    choice.chosen();
  });
  return button;
}
