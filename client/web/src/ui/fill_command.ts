// The command that gives the server a session to look at.

/** host: of the page's address; an IPv6 one in brackets, as addresses have it. */
export function fillCommand(host: string): string {
  return `meniscus simulate --particles 16000 --frames 2000 --server ${host}`;
}
