// The name of a session on the page.

interface Described {
  readonly description?: { readonly name: string } | undefined;
}

/** Controls, and characters that change the direction of the text around them: a server allows none, this page trusts none. */
const unwanted = /[\p{Cc}\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069]/gu;

/** Empty: it has none. Not more than a server allows, 64 characters. */
export function givenName({ description }: Described): string {
  const name = (description?.name ?? '').replace(unwanted, '').trim();
  return /^.{0,64}/su.exec(name)![0];
}

/** The beginning of a UUID, enough to distinguish a few. */
export function shortId(id: string): string {
  return id.slice(0, 8);
}
