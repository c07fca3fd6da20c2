// Puts one call's messages together to the particles of whole frames, and believes none of them.
import { ProtocolError } from '../bricks/protocol_error';
import type { Vector3 } from '../gen/meniscus/v1/settings_pb';
import type { ParticlesBegin, WatchParticlesResponse } from '../gen/meniscus/v1/surface_service_pb';
import { particleLayout, type ParticleLayout } from './particle_arrays';
import type { Particles } from './particles';

/** Far more than this viewer asks for. */
const maxParticles = 1n << 24n;
const maxBytes = 2 ** 28;

interface Arriving {
  readonly header: Omit<Particles, 'positions' | 'levels'>;
  readonly count: number;
  /** Where the levels begin among the bytes. */
  readonly levelsAt: number | undefined;
  readonly bytes: Uint8Array;
  filled: number;
}

export class ParticleReceiver {
  private arriving: Arriving | undefined;

  /** Returns the particles that the message completes. Throws ProtocolError. */
  take({ message }: WatchParticlesResponse): Particles | undefined {
    switch (message.case) {
      case 'particlesBegin':
        // One that comes before the end of the frame before abandons that frame.
        this.arriving = begin(message.value);
        return undefined;
      case 'frameChunk':
        this.add(message.value.data);
        return undefined;
      case 'frameEnd':
        return this.end();
      default:
        return undefined;
    }
  }

  private add(data: Uint8Array): void {
    const { arriving } = this;
    if (!arriving) throw new ProtocolError('particles came outside of a frame');
    if (arriving.filled + data.length > arriving.bytes.length)
      throw new ProtocolError(
        `the particles of frame ${arriving.header.index} have more than the ${arriving.bytes.length} bytes announced`,
      );
    arriving.bytes.set(data, arriving.filled);
    arriving.filled += data.length;
  }

  private end(): Particles {
    const { arriving } = this;
    if (!arriving) throw new ProtocolError('particles ended without having begun');
    const { header, count, levelsAt, bytes, filled } = arriving;
    if (filled !== bytes.length)
      throw new ProtocolError(`the particles of frame ${header.index} ended after ${filled} of ${bytes.length} bytes`);
    this.arriving = undefined;
    return {
      ...header,
      positions: new Uint16Array(bytes.buffer, 0, 3 * count),
      levels: levelsAt === undefined || count === 0 ? undefined : bytes.subarray(levelsAt, levelsAt + count),
    };
  }
}

function begin(message: ParticlesBegin): Arriving {
  const name = `the particles of frame ${message.frameIndex}`;
  if (message.sentCount > maxParticles)
    throw new ProtocolError(`${name} are ${message.sentCount}; at most ${maxParticles} are taken`);
  if (!(message.particleRadius > 0) || !Number.isFinite(message.particleRadius))
    throw new ProtocolError(`${name} have the radius ${message.particleRadius}`);
  const min = corner(message.quantizationBox?.min);
  const max = corner(message.quantizationBox?.max);
  if (!min || !max) throw new ProtocolError(`${name} have no finite box`);
  const count = Number(message.sentCount);
  const { particleBytes, levelsAfter } = layoutOf(message, name);
  if (count * particleBytes > maxBytes)
    throw new ProtocolError(`${name} have ${count * particleBytes} bytes; at most ${maxBytes} are taken`);
  return {
    header: {
      index: message.frameIndex,
      runId: message.runId,
      frameCount: Number(message.particleCount),
      stride: Number(message.stride),
      min,
      max,
      radius: message.particleRadius,
    },
    count,
    levelsAt: levelsAfter === undefined ? undefined : count * levelsAfter,
    bytes: new Uint8Array(count * particleBytes),
    filled: 0,
  };
}

function layoutOf({ arrays }: ParticlesBegin, name: string): ParticleLayout {
  try {
    return particleLayout(arrays);
  } catch (error) {
    throw new ProtocolError(`${name}: ${error instanceof Error ? error.message : String(error)}`);
  }
}

function corner(wire: Vector3 | undefined): [number, number, number] | undefined {
  if (!wire || ![wire.x, wire.y, wire.z].every(Number.isFinite)) return undefined;
  return [wire.x, wire.y, wire.z];
}
