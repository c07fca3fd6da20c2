// Puts a list's items in order and moves only those that are out of place, so that what has the focus, or is being clicked, stays.

export function arrange(list: HTMLElement, items: readonly HTMLElement[]): void {
  const { activeElement } = document;
  const wanted = new Set(items);
  for (const child of [...list.children]) if (!wanted.has(child as HTMLElement)) child.remove();
  items.forEach((item, i) => {
    if (list.children[i] !== item) list.insertBefore(item, list.children[i] ?? null);
  });
  // An element that was moved has lost the focus.
  if (activeElement instanceof HTMLElement && activeElement !== document.activeElement && list.contains(activeElement))
    activeElement.focus({ preventScroll: true });
}
