// Which sessions the list shows, and in which order.

interface Listed {
  readonly id: string;
  readonly uploading: boolean;
  /** Microseconds since 1970. */
  readonly createdAt: bigint;
}

/** Live ones first; of each kind the newest first. The order of two sessions changes only when one of them begins or stops. */
export function inOrder<Session extends Listed>(sessions: readonly Session[]): Session[] {
  return [...sessions].sort(
    (a, b) =>
      Number(b.uploading) - Number(a.uploading) ||
      Number(b.createdAt - a.createdAt) ||
      (a.id < b.id ? -1 : a.id > b.id ? 1 : 0),
  );
}

/** Whether every word of the search is found in one of the texts, whatever the case or the form of its characters. */
export function matches(search: string, ...texts: readonly string[]): boolean {
  const within = texts.map(folded);
  return folded(search)
    .split(/\s+/)
    .every((word) => within.some((text) => text.includes(word)));
}

function folded(text: string): string {
  return text.normalize('NFKC').toLowerCase();
}
