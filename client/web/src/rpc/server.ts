// The server's calls that a viewer makes.
import type { MessageInitShape } from '@bufbuild/protobuf';
import { SessionService, type Session } from '../gen/meniscus/v1/session_service_pb';
import { ServerService, type GetServerInfoResponse } from '../gen/meniscus/v1/server_service_pb';
import { SurfaceService, type WatchRequestSchema, type WatchResponse } from '../gen/meniscus/v1/surface_service_pb';
import { serverStream, unary, type CallOptions, type Endpoint, type Received } from './call';

export type WatchRequestInit = MessageInitShape<typeof WatchRequestSchema>;

const unaryTimeout = 10_000;  // ms

export class Server {
  /** Sent as a bearer token; empty: none. */
  token = '';
  /** Of the unary call answered last, ms: an estimate of the link's round trip. */
  roundTrip = 0;

  constructor(private readonly endpoint: Endpoint) {}

  async info(): Promise<GetServerInfoResponse> {
    return this.timed(() => unary(this.endpoint, ServerService.method.getServerInfo, {}, this.options(AbortSignal.timeout(unaryTimeout))));
  }

  async sessions(): Promise<Session[]> {
    const answer = await this.timed(() =>
      unary(this.endpoint, SessionService.method.listSessions, {}, this.options(AbortSignal.timeout(unaryTimeout))),
    );
    return answer.sessions;
  }

  watch(request: WatchRequestInit & { sessionId: string }, signal: AbortSignal): AsyncIterable<Received<WatchResponse>> {
    return serverStream(this.endpoint, SurfaceService.method.watch, request, this.options(signal, request.sessionId));
  }

  private options(signal: AbortSignal, sessionId?: string): CallOptions {
    const metadata: Record<string, string> = {};
    if (this.token !== '') metadata.authorization = `Bearer ${this.token}`;
    if (sessionId !== undefined) metadata['x-session-id'] = sessionId;
    return { signal, metadata };
  }

  private async timed<T>(call: () => Promise<T>): Promise<T> {
    const start = performance.now();
    const answer = await call();
    this.roundTrip = performance.now() - start;
    return answer;
  }
}
