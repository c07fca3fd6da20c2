// Where the files of a publication come from: a host of plain files, or the page itself.
import { fromBase64 } from '../base64';
import { ProtocolError } from '../bricks/protocol_error';
import { manifestName } from './manifest';

/** A file cannot be had now: it may be later. */
export class FileUnavailable extends Error {}
/** There is no such file. */
export class FileMissing extends Error {}
/** The server asks for a token, or for another one. */
export class TokenNeeded extends Error {}

export interface PublicationFiles {
  /** Throws FileUnavailable, FileMissing, TokenNeeded, or ProtocolError for a file of more than `most` bytes. */
  read(name: string, most: number, signal: AbortSignal): Promise<Uint8Array>;
}

/** url: of a folder, or of its manifest. token: of the viewer's own server, "" for none yet; no other host is shown one. */
export function filesAt(
  url: URL,
  get: typeof fetch = (...what) => fetch(...what),
  token?: () => string,
): PublicationFiles {
  const manifest = url.pathname.endsWith('.json') ? url : new URL(manifestName, withSlash(url));
  return {
    async read(name, most, signal) {
      const at = name === manifestName ? manifest : new URL(name, manifest);
      // The manifest alone changes.
      const cache = name === manifestName ? 'no-cache' : 'default';
      let response: Response;
      try {
        response = await get(at.href, { signal, cache, redirect: 'manual', headers: headersWith(token?.()) });
      } catch (error) {
        if (signal.aborted) throw error;
        throw new FileUnavailable(`${at.host} cannot be reached, or does not let this page read.`);
      }
      if (response.type === 'opaqueredirect')
        throw new ProtocolError(`${name} leads elsewhere, where this viewer does not follow`);
      if (response.status === 401 && token) throw new TokenNeeded(`${at.host} asks for a token.`);
      if (response.status === 404 || response.status === 410)
        throw new FileMissing(`There is no ${name} at ${at.host}.`);
      if (!response.ok) throw new FileUnavailable(`${at.host} answers for ${name} with the status ${response.status}.`);
      try {
        return await bodyOf(response, most, name);
      } catch (error) {
        if (signal.aborted || error instanceof ProtocolError) throw error;
        throw new FileUnavailable(`${name} broke off.`);
      }
    },
  };
}

/** Those of a page that is a file of its own; none of any other. */
export function filesInPage(page: Document): PublicationFiles | undefined {
  const find = (name: string) => page.querySelector(`script[data-file="${name}"]`);
  if (!find(manifestName)) return undefined;
  return {
    read(name, most) {
      const text = find(name)?.textContent;
      if (text === undefined) return Promise.reject(new FileMissing(`The page has no ${name}.`));
      if (text.length > 2 * most + 4) return Promise.reject(new ProtocolError(`${name} has more than ${most} bytes`));
      try {
        return Promise.resolve(fromBase64(text));
      } catch {
        return Promise.reject(new ProtocolError(`the page's ${name} was cut or changed`));
      }
    },
  };
}

function headersWith(token = ''): HeadersInit {
  return token === '' ? {} : { authorization: `Bearer ${token}` };
}

function withSlash(url: URL): URL {
  const folder = new URL(url);
  if (!folder.pathname.endsWith('/')) folder.pathname += '/';
  return folder;
}

/** Reads no further than `most` bytes. */
async function bodyOf(response: Response, most: number, name: string): Promise<Uint8Array> {
  const parts: Uint8Array[] = [];
  let size = 0;
  const reader = response.body?.getReader();
  for (let part = await reader?.read(); part && !part.done; part = await reader?.read()) {
    size += part.value.length;
    if (size > most) {
      void reader?.cancel();
      throw new ProtocolError(`${name} has more than the ${most} bytes that are expected`);
    }
    parts.push(part.value);
  }
  const whole = new Uint8Array(size);
  let at = 0;
  for (const part of parts) {
    whole.set(part, at);
    at += part.length;
  }
  return whole;
}
