// A list of names and values, each with its color.

/** Adds a row to the list; returns where its value stands. */
export function legendRow(list: HTMLDListElement, name: string, color: string): HTMLElement {
  const term = document.createElement('dt');
  const swatch = document.createElement('span');
  swatch.className = 'swatch';
  swatch.style.background = color;
  term.append(swatch, name);
  const value = document.createElement('dd');
  const row = document.createElement('div');
  row.append(term, value);
  list.append(row);
  return value;
}
