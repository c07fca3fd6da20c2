// The names of a bar's icons for fingers, which do not hover: pressed long, a button says what it does, and does not do it.

/** ms */
const long = 450;
const stays = 1500;

export function nameOnLongPress(bar: HTMLElement, hint: HTMLElement): void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  let named = false;

  const release = (): void => {
    clearTimeout(timer);
    if (named)
      timer = setTimeout(() => {
        hint.hidden = true;
        // A click that has not come by now does not belong to it.
        named = false;
      }, stays);
  };
  bar.addEventListener('pointerdown', ({ pointerType, target }) => {
    clearTimeout(timer);
    hint.hidden = true;
    named = false;
    const control = (target as Element).closest<HTMLElement>('button, label');
    if (pointerType !== 'touch' || !control) return;
    timer = setTimeout(() => {
      named = true;
      hint.textContent = control.title;
      hint.hidden = false;
      // Above the finger, and within the page.
      const { left, width, top } = control.getBoundingClientRect();
      const half = hint.offsetWidth / 2 + 8;
      const middle = Math.min(Math.max(left + width / 2, half), document.documentElement.clientWidth - half);
      hint.style.left = `${middle}px`;
      hint.style.bottom = `${document.documentElement.clientHeight - top + 8}px`;
    }, long);
  });
  bar.addEventListener('pointerup', release);
  // The bar scrolls under the finger.
  bar.addEventListener('pointercancel', release);
  bar.addEventListener(
    'click',
    (event) => {
      if (!named) return;
      named = false;
      event.preventDefault();
      event.stopPropagation();
    },
    true,
  );
  bar.addEventListener('contextmenu', (event) => {
    if (named) event.preventDefault();
  });
}
