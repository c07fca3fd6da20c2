// How a call ended: the gRPC status in HTTP headers or in the message of trailers.
import { Code, isCode, RpcError } from './status';

/** Lines "name: value", ended by CR LF; names in lower case. */
export function parseTrailers(data: Uint8Array): Map<string, string> {
  const trailers = new Map<string, string>();
  for (const line of new TextDecoder().decode(data).split('\r\n')) {
    const colon = line.indexOf(':');
    if (colon > 0) trailers.set(line.slice(0, colon).trim().toLowerCase(), line.slice(colon + 1).trim());
  }
  return trailers;
}

/** The error that a call ended with; none for OK. `get` finds a header or trailer by its name. */
export function statusError(get: (name: string) => string | null | undefined): RpcError | undefined {
  const text = get('grpc-status');
  const code = Number(text);
  if (text === null || text === undefined || text === '' || !isCode(code))
    return new RpcError(Code.unknown, `The server ended the call with the status "${text ?? ''}".`);
  if (code === Code.ok) return undefined;
  return new RpcError(code, decodeMessage(get('grpc-message') ?? ''));
}

/** grpc-message is percent-encoded UTF-8; what is not is shown as it came. */
function decodeMessage(text: string): string {
  try {
    return decodeURIComponent(text);
  } catch {
    return text;
  }
}
