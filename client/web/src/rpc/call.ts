// gRPC-Web (binary) over fetch: unary calls and server streams.
import {
  create,
  fromBinary,
  toBinary,
  type DescMessage,
  type DescMethodServerStreaming,
  type DescMethodUnary,
  type MessageInitShape,
  type MessageShape,
} from '@bufbuild/protobuf';
import { MessageParser } from './message_parser';
import { Code, codeOfHttpStatus, RpcError } from './status';
import { parseTrailers, statusError } from './trailers';

/** As gRPC's default; the server's messages are about a MiB at most. */
const maxMessageBytes = 4 << 20;
const contentType = 'application/grpc-web+proto';

export interface Endpoint {
  /** The URL before the path of a call: "" for the page's own server. */
  readonly base: string;
  readonly fetch: typeof fetch;
}

export interface CallOptions {
  readonly signal: AbortSignal;
  /** Sent as headers. */
  readonly metadata: Readonly<Record<string, string>>;
  /** The server has taken the call. */
  readonly opened?: () => void;
  /** The call has ended with OK and these trailers. */
  readonly ended?: (trailers: ReadonlyMap<string, string>) => void;
}

export interface Received<Message> {
  readonly message: Message;
  /** On the wire. */
  readonly bytes: number;
}

/** Yields the stream's messages; returns when it ends with OK, throws RpcError otherwise. */
export async function* serverStream<I extends DescMessage, O extends DescMessage>(
  endpoint: Endpoint,
  method: DescMethodServerStreaming<I, O>,
  request: MessageInitShape<I>,
  options: CallOptions,
): AsyncGenerator<Received<MessageShape<O>>, void> {
  for await (const data of messages(
    endpoint,
    path(method),
    toBinary(method.input, create(method.input, request)),
    options,
  ))
    yield { message: fromBinary(method.output, data), bytes: data.length };
}

/** The one message of the answer. Throws RpcError. */
export async function unary<I extends DescMessage, O extends DescMessage>(
  endpoint: Endpoint,
  method: DescMethodUnary<I, O>,
  request: MessageInitShape<I>,
  options: CallOptions,
): Promise<MessageShape<O>> {
  let answer: MessageShape<O> | undefined;
  for await (const data of messages(
    endpoint,
    path(method),
    toBinary(method.input, create(method.input, request)),
    options,
  ))
    answer = fromBinary(method.output, data);
  if (answer === undefined) throw new RpcError(Code.internal, 'The server answered without a message.');
  return answer;
}

function path(method: { readonly name: string; readonly parent: { readonly typeName: string } }): string {
  return `/${method.parent.typeName}/${method.name}`;
}

async function* messages(
  endpoint: Endpoint,
  path: string,
  request: Uint8Array,
  options: CallOptions,
): AsyncGenerator<Uint8Array, void> {
  try {
    yield* answer(endpoint, path, request, options);
  } catch (error) {
    if (error instanceof RpcError) error.withToken = options.metadata.authorization !== undefined;
    throw error;
  }
}

async function* answer(
  endpoint: Endpoint,
  path: string,
  request: Uint8Array,
  options: CallOptions,
): AsyncGenerator<Uint8Array, void> {
  const response = await post(endpoint, path, request, options);
  // A call that is refused at once may have its status in the headers, and no body.
  if (response.headers.get('grpc-status') !== null) {
    const error = statusError((name) => response.headers.get(name));
    if (error) throw error;
  }
  if (!response.ok) throw new RpcError(codeOfHttpStatus(response.status), await shortText(response));
  if (!(response.headers.get('content-type') ?? '').startsWith('application/grpc-web'))
    throw new RpcError(Code.unimplemented, `${endpoint.base}${path} is not answered in gRPC-Web`);
  if (response.body === null) throw new RpcError(Code.unavailable, 'The server answered without a body.');
  options.opened?.();
  const parser = new MessageParser(maxMessageBytes);
  for await (const chunk of chunks(response.body, options.signal))
    for (const message of parser.push(chunk)) {
      if (!message.trailers) {
        yield message.data;
        continue;
      }
      const trailers = parseTrailers(message.data);
      const error = statusError((name) => trailers.get(name));
      if (error) throw error;
      options.ended?.(trailers);
      return;
    }
  throw new RpcError(
    Code.unavailable,
    parser.atBoundary ? 'The connection ended.' : 'The connection ended within a message.',
  );
}

async function post(endpoint: Endpoint, path: string, request: Uint8Array, options: CallOptions): Promise<Response> {
  const body = new Uint8Array(5 + request.length);
  new DataView(body.buffer).setUint32(1, request.length);
  body.set(request, 5);
  try {
    return await endpoint.fetch(endpoint.base + path, {
      method: 'POST',
      headers: { ...options.metadata, 'content-type': contentType, accept: contentType, 'x-grpc-web': '1' },
      body,
      cache: 'no-store',
      signal: options.signal,
    });
  } catch (error) {
    throw connectionError(error, options.signal);
  }
}

async function* chunks(body: ReadableStream<Uint8Array>, signal: AbortSignal): AsyncGenerator<Uint8Array, void> {
  const reader = body.getReader();
  try {
    for (;;) {
      const { done, value } = await reader.read();
      if (done) return;
      yield value;
    }
  } catch (error) {
    throw connectionError(error, signal);
  } finally {
    // Ends the call where the reader has left it early.
    reader.cancel().catch(() => undefined);
  }
}

function connectionError(error: unknown, signal: AbortSignal): RpcError {
  if (error instanceof RpcError) return error;
  if (signal.aborted) {
    const late = signal.reason instanceof DOMException && signal.reason.name === 'TimeoutError';
    return new RpcError(late ? Code.deadlineExceeded : Code.canceled, late ? 'no answer in time' : 'canceled');
  }
  return new RpcError(Code.unavailable, error instanceof Error ? error.message : String(error));
}

async function shortText(response: Response): Promise<string> {
  const text = await response.text().catch(() => '');
  return text.trim().slice(0, 300) || `HTTP status ${response.status}`;
}
