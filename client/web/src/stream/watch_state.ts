// Where a watch stands.

export interface SessionEnd {
  /** ms since 1970. */
  readonly at: number;
  /** The server's words, within a sentence; "": unknown. */
  readonly reason: string;
}

export type WatchState =
  | { readonly kind: 'connecting' }
  /** Connected; no mesh has come on this call yet. */
  | { readonly kind: 'connected' }
  /** Meshes come as the simulator makes them. */
  | { readonly kind: 'live' }
  /** Paused by the viewer, or hidden. */
  | { readonly kind: 'paused' }
  /** The server goes down and has said so. */
  | { readonly kind: 'draining'; readonly seconds: number }
  /** Tries again at that time of the page's clock, ms. */
  | { readonly kind: 'waiting'; readonly retryAt: number; readonly reason: string }
  /** There is no such session on the server, or none any more; it is looked for again at that time of the page's clock, ms. */
  | { readonly kind: 'absent'; readonly retryAt: number; readonly reason: string }
  | ({ readonly kind: 'ended' } & SessionEnd)
  | { readonly kind: 'token'; readonly reason: string }
  | { readonly kind: 'refused'; readonly reason: string };
