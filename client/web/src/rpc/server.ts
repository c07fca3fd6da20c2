// The server's calls that a viewer makes.
import type { MessageInitShape } from '@bufbuild/protobuf';
import {
  RecordingService,
  type ReadRecordingRequestSchema,
  type Recording,
} from '../gen/meniscus/v1/recording_service_pb';
import { SessionService, type Session } from '../gen/meniscus/v1/session_service_pb';
import { Codec } from '../gen/meniscus/v1/mesh_pb';
import { ServerService, type GetServerInfoResponse } from '../gen/meniscus/v1/server_service_pb';
import {
  SurfaceService,
  type WatchParticlesResponse,
  type WatchRequestSchema,
  type WatchResponse,
} from '../gen/meniscus/v1/surface_service_pb';
import { Code, RpcError } from './status';
import { serverStream, unary, type CallOptions, type Endpoint, type Received } from './call';

export type WatchRequestInit = MessageInitShape<typeof WatchRequestSchema>;
export type ReadRequestInit = MessageInitShape<typeof ReadRecordingRequestSchema>;

const unaryTimeout = 10_000; // ms

export class Server {
  /** Sent as a bearer token; empty: none. */
  token = '';
  private shortestAnswer = Infinity;
  /** What the server offers of the codecs; none: it is to be asked. */
  private offered: Promise<readonly Codec[]> | undefined;

  /** codecs: of bricks, the preferred one first. normals: of all meshes, whatever a request says of them. */
  constructor(
    private readonly endpoint: Endpoint,
    private readonly codecs: readonly Codec[],
    private readonly normals: { readonly normalBits?: number } = {},
  ) {}

  /** The link's round trip, ms: the shortest time from a call to its answer; 0 before the first. */
  get roundTrip(): number {
    return Number.isFinite(this.shortestAnswer) ? this.shortestAnswer : 0;
  }

  async info(): Promise<GetServerInfoResponse> {
    return unary(
      this.endpoint,
      ServerService.method.getServerInfo,
      {},
      this.options(AbortSignal.timeout(unaryTimeout)),
    );
  }

  async sessions(): Promise<Session[]> {
    const answer = await unary(
      this.endpoint,
      SessionService.method.listSessions,
      {},
      this.options(AbortSignal.timeout(unaryTimeout)),
    );
    return answer.sessions;
  }

  async session(id: string): Promise<Session> {
    const answer = await unary(
      this.endpoint,
      SessionService.method.getSession,
      { id },
      this.options(AbortSignal.timeout(unaryTimeout), id),
    );
    if (!answer.session) throw new RpcError(Code.internal, 'The server answered without a session.');
    return answer.session;
  }

  /** The session's newest mesh as it is at `maxLevel`; nothing where there is none yet. */
  snapshot(
    request: { sessionId: string; maxLevel: number },
    signal: AbortSignal,
  ): AsyncIterable<Received<WatchResponse>> {
    return this.meshes(signal, (codecs) =>
      serverStream(
        this.endpoint,
        SurfaceService.method.snapshot,
        { ...request, ...this.normals, codecs },
        this.options(signal, request.sessionId),
      ),
    );
  }

  /** opened: the server has taken the call. ended: it has ended well, with its session; reason: "" of an older server. */
  watch(
    request: WatchRequestInit & { sessionId: string },
    signal: AbortSignal,
    opened: () => void,
    ended?: (reason: string) => void,
  ): AsyncIterable<Received<WatchResponse>> {
    return this.meshes(signal, (codecs) =>
      serverStream(
        this.endpoint,
        SurfaceService.method.watch,
        { ...request, ...this.normals, codecs, withSpray: true },
        {
          ...this.options(signal, request.sessionId, opened),
          ended: (trailers) => ended?.(trailers.get('x-session-end') ?? ''),
        },
      ),
    );
  }

  watchParticles(
    request: { sessionId: string; maxParticles: bigint },
    signal: AbortSignal,
  ): AsyncIterable<Received<WatchParticlesResponse>> {
    return serverStream(
      this.endpoint,
      SurfaceService.method.watchParticles,
      request,
      this.options(signal, request.sessionId),
    );
  }

  async recordings(): Promise<Recording[]> {
    const answer = await unary(
      this.endpoint,
      RecordingService.method.listRecordings,
      {},
      this.options(AbortSignal.timeout(unaryTimeout)),
    );
    return answer.recordings;
  }

  readRecording(
    request: ReadRequestInit & { sessionId: string },
    signal: AbortSignal,
  ): AsyncIterable<Received<WatchResponse>> {
    return this.meshes(signal, (codecs) =>
      serverStream(
        this.endpoint,
        RecordingService.method.readRecording,
        { ...request, codecs, withSpray: true },
        this.options(signal, request.sessionId),
      ),
    );
  }

  /** A call that names codecs. After one that failed another server may answer. */
  private async *meshes(
    signal: AbortSignal,
    open: (codecs: Codec[]) => AsyncIterable<Received<WatchResponse>>,
  ): AsyncIterable<Received<WatchResponse>> {
    try {
      yield* open(await this.askedCodecs());
    } catch (error) {
      if (!signal.aborted) this.offered = undefined;
      throw error;
    }
  }

  /** A server refuses codecs that it does not offer. */
  private async askedCodecs(): Promise<Codec[]> {
    if (this.codecs.every((codec) => codec === Codec.DRACO)) return [Codec.DRACO];
    this.offered ??= this.info().then(
      ({ codecs }) => codecs,
      (error: unknown) => {
        this.offered = undefined;
        throw error;
      },
    );
    const offered = await this.offered;
    const asked = this.codecs.filter((codec) => offered.includes(codec));
    return asked.length > 0 ? asked : [Codec.DRACO];
  }

  private options(signal: AbortSignal, sessionId?: string, opened?: () => void): CallOptions {
    const metadata: Record<string, string> = {};
    if (this.token !== '') metadata.authorization = `Bearer ${this.token}`;
    if (sessionId !== undefined) metadata['x-session-id'] = sessionId;
    const asked = performance.now();
    return {
      signal,
      metadata,
      opened: () => {
        this.shortestAnswer = Math.min(this.shortestAnswer, performance.now() - asked);
        opened?.();
      },
    };
  }
}
