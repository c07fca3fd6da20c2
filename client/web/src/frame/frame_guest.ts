// The viewer's end, in a frame of another page: takes what that page hands over, from that page alone.
import { isShow, readShow, type HandedOver, type Ready } from './messages';

/** The part of a window that is needed. */
export interface GuestWindow {
  readonly parent: { postMessage(message: Ready, origin: string): void };
  addEventListener(type: 'message', listener: (event: MessageEvent<unknown>) => void): void;
}

export interface GuestEvents {
  show(handed: HandedOver): void;
  /** For a person. */
  refused(reason: string): void;
}

/**
 * page: origin of the page around, as the address says; a browser lets only pages that the server lists be around. nonce: new for
 * each viewer, not to be guessed.
 */
export function listenToPage(window: GuestWindow, page: string, nonce: string, events: GuestEvents): void {
  let last = 0;
  window.addEventListener('message', ({ data, origin, source }) => {
    if (origin !== page || source !== window.parent || !isShow(data) || data.nonce !== nonce) return;
    // One that is said again is not obeyed again.
    if (typeof data.number !== 'number' || !(data.number > last)) return;
    last = data.number;
    try {
      events.show(readShow(data));
    } catch (error) {
      events.refused(error instanceof Error ? error.message : String(error));
    }
  });
  // A page of another origin does not hear it.
  window.parent.postMessage({ meniscus: 'ready', nonce }, page);
}
