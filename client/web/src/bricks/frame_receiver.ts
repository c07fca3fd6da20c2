// Puts one call's messages together to whole frames, and believes none of them.
import type { FrameStatistics, MeshBegin, MeshBrick, SprayPoints } from '../gen/meniscus/v1/mesh_pb';
import type { WatchResponse } from '../gen/meniscus/v1/surface_service_pb';
import { readAttributes, type CodedAttribute, type VertexAttribute } from './attributes';
import { isKnownCodec, knownCodecs } from './codecs';
import { brickKey, type BrickKey, type EncodedBrick, type Frame } from './frame';
import { brickCells, maxOffsetBits, minOffsetBits } from './lattice';
import { ProtocolError } from './protocol_error';

/** More than any mesh has that a browser could show. */
const maxBricks = 1 << 20;
/** x y z, float32. */
const sprayPointBytes = 12;

interface Arriving {
  readonly begin: MeshBegin;
  readonly beganAt: number;
  readonly attributes: readonly VertexAttribute[];
  /** The coded attributes of the bricks that arrive. */
  readonly coded: readonly CodedAttribute[];
  readonly bricks: Map<BrickKey, EncodedBrick>;
  readonly arrived: Set<BrickKey>;
  readonly spray: Uint8Array[];
  sprayCount: number;
  bytes: number;
}

interface PartialBrick {
  readonly first: MeshBrick;
  readonly parts: Uint8Array[];
}

export class FrameReceiver {
  private last: Frame | undefined;
  private arriving: Arriving | undefined;
  private partial: PartialBrick | undefined;

  /** Whether a mesh has come on this call, or a part of one. */
  get begun(): boolean {
    return this.arriving !== undefined || this.last !== undefined;
  }

  /** Returns the frame that the message completes. Throws ProtocolError. */
  take(response: WatchResponse, bytes: number, now: number): Frame | undefined {
    const { message } = response;
    if (this.arriving) this.arriving.bytes += bytes;
    switch (message.case) {
      case 'meshBegin':
        this.begin(message.value, bytes, now);
        return undefined;
      case 'meshBrick':
        this.add(message.value);
        return undefined;
      case 'sprayPoints':
        this.addSpray(message.value);
        return undefined;
      case 'frameStatistics':
        return this.end(message.value, now);
      default:
        return undefined;
    }
  }

  /** One that comes before the end of the frame before abandons that frame. */
  private begin(begin: MeshBegin, bytes: number, now: number): void {
    const name = `frame ${begin.frameIndex}`;
    this.partial = undefined;
    this.arriving = undefined;
    if (begin.brickCells !== brickCells)
      throw new ProtocolError(`${name} has bricks of ${begin.brickCells} cells; this viewer knows ${brickCells}`);
    if (begin.offsetBits < minOffsetBits || begin.offsetBits > maxOffsetBits)
      throw new ProtocolError(
        `${name} has offset_bits ${begin.offsetBits}; allowed are ${minOffsetBits} to ${maxOffsetBits}`,
      );
    if (!Number.isFinite(begin.cellSize) || begin.cellSize <= 0)
      throw new ProtocolError(`${name} has cell_size ${begin.cellSize}`);
    if (begin.brickCount > maxBricks)
      throw new ProtocolError(`${name} has ${begin.brickCount} bricks; at most ${maxBricks} are taken`);
    this.arriving = {
      begin,
      beganAt: now,
      ...readAttributes(begin.attributes, name),
      bricks: this.baseBricks(begin, name),
      arrived: new Set(),
      spray: [],
      sprayCount: 0,
      bytes,
    };
  }

  /** The bricks that stay from the base. */
  private baseBricks(begin: MeshBegin, name: string): Map<BrickKey, EncodedBrick> {
    if (begin.baseFrameIndex === undefined) {
      if (begin.vanished.length > 0) throw new ProtocolError(`${name} has bricks that vanished, but no base`);
      return new Map();
    }
    if (this.last?.index !== begin.baseFrameIndex)
      throw new ProtocolError(
        `${name} is the difference to frame ${begin.baseFrameIndex}; the last one was ${this.last?.index ?? 'none'}`,
      );
    if (this.last.offsetBits !== begin.offsetBits || this.last.cellSize !== begin.cellSize)
      throw new ProtocolError(`${name} is the difference to a frame on another lattice`);
    const bricks = new Map(this.last.bricks);
    for (const { x, y, z } of begin.vanished)
      if (!bricks.delete(brickKey(x, y, z)))
        throw new ProtocolError(`${name}: brick (${x}, ${y}, ${z}) vanished without having been`);
    return bricks;
  }

  private add(brick: MeshBrick): void {
    const { arriving } = this;
    if (!arriving) throw new ProtocolError('a brick came outside of a frame');
    const name = `frame ${arriving.begin.frameIndex}, brick (${brick.x}, ${brick.y}, ${brick.z})`;
    if (!this.partial) {
      if (brick.partIndex !== 0 || brick.partCount === 0)
        throw new ProtocolError(`${name} begins with part ${brick.partIndex} of ${brick.partCount}`);
      if (arriving.arrived.size === arriving.begin.brickCount)
        throw new ProtocolError(`${name} is one more than the ${arriving.begin.brickCount} that were announced`);
      if (!isKnownCodec(brick.codec))
        throw new ProtocolError(
          `${name} has the codec ${brick.codec}, which this viewer does not know; it knows ${knownCodecs.join(', ')}`,
        );
      this.partial = { first: brick, parts: [] };
    }
    const { first, parts } = this.partial;
    if (
      brick.x !== first.x ||
      brick.y !== first.y ||
      brick.z !== first.z ||
      brick.codec !== first.codec ||
      brick.partIndex !== parts.length ||
      brick.partCount !== first.partCount
    )
      throw new ProtocolError(
        `${name}, part ${brick.partIndex} of ${brick.partCount}, came in place of part ${parts.length} of (${first.x}, ${first.y}, ${first.z})`,
      );
    parts.push(brick.data);
    if (parts.length < first.partCount) return;
    this.partial = undefined;
    const key = brickKey(first.x, first.y, first.z);
    if (arriving.arrived.has(key)) throw new ProtocolError(`${name} came twice`);
    arriving.arrived.add(key);
    arriving.bricks.set(key, {
      place: [first.x, first.y, first.z],
      vertexCount: first.vertexCount,
      triangleCount: first.triangleCount,
      cellLevels: first.cellLevels.slice(),
      codec: first.codec,
      data: concatenate(parts),
      attributes: arriving.coded,
    });
  }

  private addSpray({ positions }: SprayPoints): void {
    const { arriving } = this;
    if (!arriving) throw new ProtocolError('spray came outside of a frame');
    const name = `frame ${arriving.begin.frameIndex}`;
    if (positions.length === 0 || positions.length % sprayPointBytes !== 0)
      throw new ProtocolError(`${name} has spray of ${positions.length} bytes, which are no whole points`);
    arriving.spray.push(positions);
    arriving.sprayCount += positions.length / sprayPointBytes;
    if (arriving.sprayCount > arriving.begin.sprayCount)
      throw new ProtocolError(
        `${name} has spray of more than the ${arriving.begin.sprayCount} points that were announced`,
      );
  }

  private end(statistics: FrameStatistics, now: number): Frame {
    const { arriving } = this;
    if (arriving?.begin.frameIndex !== statistics.frameIndex)
      throw new ProtocolError(`statistics of frame ${statistics.frameIndex} came without its mesh`);
    const { begin, bricks } = arriving;
    if (this.partial || arriving.arrived.size !== begin.brickCount)
      throw new ProtocolError(
        `frame ${begin.frameIndex} ended after ${arriving.arrived.size} of ${begin.brickCount} bricks`,
      );
    let triangleCount = 0;
    for (const brick of bricks.values()) triangleCount += brick.triangleCount;
    if (BigInt(triangleCount) !== begin.triangleCount)
      throw new ProtocolError(
        `frame ${begin.frameIndex} has bricks of ${triangleCount} triangles; announced were ${begin.triangleCount}`,
      );
    if (BigInt(arriving.sprayCount) !== begin.sprayCount)
      throw new ProtocolError(
        `frame ${begin.frameIndex} ended after ${arriving.sprayCount} of ${begin.sprayCount} points of spray`,
      );
    this.arriving = undefined;
    this.last = {
      index: begin.frameIndex,
      runId: begin.runId,
      simulationTime: begin.simulationTime,
      cellSize: begin.cellSize,
      offsetBits: begin.offsetBits,
      brickCells: begin.brickCells,
      bricks,
      triangleCount,
      attributes: arriving.attributes,
      spray: new Float32Array(concatenate(arriving.spray).buffer),
      statistics,
      bytes: arriving.bytes,
      beganAt: arriving.beganAt,
      arrivedAt: now,
    };
    return this.last;
  }
}

/** A copy: what came over the wire shares large buffers, which are not to be kept, nor sent to workers. */
function concatenate(parts: Uint8Array[]): Uint8Array {
  const whole = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    whole.set(part, at);
    at += part.length;
  }
  return whole;
}
