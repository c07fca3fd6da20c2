// Receives a session's particles for as long as they are wanted; tries again after what may pass.
import type { WatchParticlesResponse } from '../gen/meniscus/v1/surface_service_pb';
import { ParticleReceiver } from '../particles/particle_receiver';
import type { Particles } from '../particles/particles';
import type { Received } from '../rpc/call';
import { Code, explain, RpcError } from '../rpc/status';
import { Backoff, reconnecting } from './backoff';

/** More would draw slowly, and come slowly. */
export const maxParticles = 100_000n;

export interface ParticleServer {
  watchParticles(
    request: { sessionId: string; maxParticles: bigint },
    signal: AbortSignal,
  ): AsyncIterable<Received<WatchParticlesResponse>>;
}

export interface ParticleWatchEvents {
  particles(particles: Particles): void;
  /** For a person. It is tried again. */
  failed(reason: string): void;
  received(bytes: number): void;
}

/** The watch of the meshes reports these, too. */
const reportedElsewhere: ReadonlySet<Code> = new Set([
  Code.unavailable,
  Code.notFound,
  Code.unauthenticated,
  Code.permissionDenied,
]);

export class ParticleWatch {
  private readonly backoff = new Backoff(reconnecting);
  private call: AbortController | undefined;
  private retry: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly server: ParticleServer,
    private readonly sessionId: string,
    private readonly events: ParticleWatchEvents,
  ) {}

  setWanted(wanted: boolean): void {
    if (wanted === (this.call !== undefined)) return;
    if (!wanted) {
      clearTimeout(this.retry);
      this.call?.abort();
      this.call = undefined;
      return;
    }
    this.call = new AbortController();
    void this.run(this.call.signal);
  }

  private async run(signal: AbortSignal): Promise<void> {
    const receiver = new ParticleReceiver();
    try {
      for await (const { message, bytes } of this.server.watchParticles(
        { sessionId: this.sessionId, maxParticles },
        signal,
      )) {
        if (signal.aborted) return;
        this.events.received(bytes);
        const particles = receiver.take(message);
        if (!particles) continue;
        this.backoff.reset();
        this.events.particles(particles);
      }
    } catch (error) {
      if (signal.aborted) return;
      if (!(error instanceof RpcError && reportedElsewhere.has(error.code))) this.events.failed(explain(error));
    }
    if (!signal.aborted) this.retry = setTimeout(() => void this.run(signal), this.backoff.next());
  }
}
