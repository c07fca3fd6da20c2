// gRPC statuses, and a text for people about each.

export const Code = {
  ok: 0,
  canceled: 1,
  unknown: 2,
  invalidArgument: 3,
  deadlineExceeded: 4,
  notFound: 5,
  alreadyExists: 6,
  permissionDenied: 7,
  resourceExhausted: 8,
  failedPrecondition: 9,
  aborted: 10,
  outOfRange: 11,
  unimplemented: 12,
  internal: 13,
  unavailable: 14,
  dataLoss: 15,
  unauthenticated: 16,
} as const;
export type Code = (typeof Code)[keyof typeof Code];

export class RpcError extends Error {
  /** Whether a token was sent with the call. */
  withToken = false;

  constructor(
    readonly code: Code,
    message: string,
  ) {
    super(message);
    this.name = 'RpcError';
  }
}

export function isCode(value: number): value is Code {
  return Number.isInteger(value) && value >= Code.ok && value <= Code.unauthenticated;
}

/** The code that an HTTP answer without a gRPC status stands for, as gRPC's own mapping has it. */
export function codeOfHttpStatus(status: number): Code {
  switch (status) {
    case 400:
      return Code.internal;
    case 401:
      return Code.unauthenticated;
    case 403:
      return Code.permissionDenied;
    case 404:
      return Code.unimplemented;
    case 429:
    case 502:
    case 503:
    case 504:
      return Code.unavailable;
    default:
      return Code.unknown;
  }
}

/** The text for a person. The server's own words name the error; this names its meaning for the viewer. */
export function explain(error: unknown): string {
  if (!(error instanceof RpcError)) return error instanceof Error ? error.message : String(error);
  switch (error.code) {
    case Code.unavailable:
      return 'The server cannot be reached.';
    case Code.deadlineExceeded:
      return 'The server has not answered in time.';
    case Code.unauthenticated:
      return error.withToken ? 'The server does not know this token.' : 'The server asks for a token.';
    case Code.permissionDenied:
      return `This token does not allow it (${error.message}).`;
    case Code.notFound:
      return `There is no such session: it has ended, or has not begun (${error.message}).`;
    case Code.resourceExhausted:
      return `The server is full (${error.message}).`;
    case Code.unimplemented:
      return `This server does not speak with browsers (${error.message}).`;
    default:
      return error.message === '' ? `The server refused, with status ${error.code}.` : error.message;
  }
}
