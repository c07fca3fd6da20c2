// Whether the viewer is to show the water alone: `?embed`, or `?embed=ORIGIN` for a page of that origin, which says what is shown.

export interface Embedding {
  /** The origin of the page around; none: what is shown stands in the address. */
  readonly page: string | undefined;
}

/** search: of the address. An origin that is none is left out: nobody is listened to then. */
export function readEmbedding(search: string): Embedding | undefined {
  const page = new URLSearchParams(search).get('embed');
  return page === null ? undefined : { page: isOrigin(page) ? page : undefined };
}

function isOrigin(text: string): boolean {
  try {
    const { origin, protocol } = new URL(text);
    return origin === text && (protocol === 'http:' || protocol === 'https:');
  } catch {
    return false;
  }
}
