// In a word: whether what is on the screen is live.
import type { WatchState } from '../stream/watch_state';
import { clockText } from './texts';

export interface Liveness {
  readonly text: string;
  readonly live: boolean;
}

/**
 * uploading: whether a simulator streams to the session; not known at first. restsSince: when it was seen to stop, ms since 1970.
 * None: what was said before holds.
 */
export function livenessOf(
  watch: WatchState,
  uploading: boolean | undefined,
  restsSince: number | undefined,
): Liveness | undefined {
  switch (watch.kind) {
    // Also to get other meshes, while the session goes on.
    case 'connecting':
      return undefined;
    case 'connected':
    case 'live':
      if (uploading === undefined) return undefined;
      if (uploading) return { text: 'Live', live: true };
      return {
        text: restsSince === undefined ? 'Not streaming' : `No stream since ${clockText(restsSince)}`,
        live: false,
      };
    case 'paused':
      return { text: 'Paused', live: false };
    case 'ended':
      return { text: `Ended ${clockText(watch.at)}`, live: false };
    case 'draining':
    case 'waiting':
    case 'absent':
    case 'token':
    case 'refused':
      return { text: '', live: false };
  }
}
