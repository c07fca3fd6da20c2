// The lattice codec's decoder: the module of client/web/wasm, and what it gives copied out of its memory.
import { maxAttributes } from '../bricks/attributes';

/** A brick as it was announced. */
export interface Announced {
  readonly vertices: number;
  readonly triangles: number;
  readonly offsetBits: number;
  /** Bytes of each attribute of a vertex. */
  readonly attributeBytes: readonly number[];
}

/** Addresses are numbers, and hold until the next brick. */
interface Exports {
  readonly memory: WebAssembly.Memory;
  _initialize(): void;
  input(bytes: number): number;
  attribute_bytes(): number;
  decode(vertices: number, triangles: number, offsetBits: number, attributes: number): number;
  positions(): number;
  normals(): number;
  indices(): number;
  level_triangles(): number;
  bounds(): number;
  attribute(place: number): number;
}

export class LatticeModule {
  private constructor(private readonly of: Exports) {}

  static async start(compiled: WebAssembly.Module): Promise<LatticeModule> {
    const { exports } = await WebAssembly.instantiate(compiled);
    const module = exports as unknown as Exports;
    module._initialize();
    return new LatticeModule(module);
  }

  /** Throws an Error that says what is wrong with the bytes. The functions below then have nothing to give. */
  decode(bytes: Uint8Array, { vertices, triangles, offsetBits, attributeBytes }: Announced): void {
    if (attributeBytes.length > maxAttributes) throw new Error(`it has ${attributeBytes.length} attributes`);
    const input = this.of.input(bytes.length);
    new Uint8Array(this.of.memory.buffer, input, bytes.length).set(bytes);
    new Uint32Array(this.of.memory.buffer, this.of.attribute_bytes(), maxAttributes).set(attributeBytes);
    const fault = this.of.decode(vertices, triangles, offsetBits, attributeBytes.length);
    if (fault !== 0) throw new Error(this.words(fault));
  }

  /** Brick-local: x y z and a padding per vertex. */
  positions(vertices: number): Uint16Array {
    return new Uint16Array(this.copy(this.of.positions(), 8 * vertices));
  }
  /** Unit vectors times 32767: x y z and a padding per vertex; none if the brick has none. */
  normals(vertices: number): Int16Array | undefined {
    const address = this.of.normals();
    return address === 0 ? undefined : new Int16Array(this.copy(address, 8 * vertices));
  }
  /** Three vertices per triangle, ordered by level. */
  indices(vertices: number, triangles: number): Uint16Array | Uint32Array {
    const address = this.of.indices();
    return vertices <= 0xffff
      ? new Uint16Array(this.copy(address, 6 * triangles))
      : new Uint32Array(this.copy(address, 12 * triangles));
  }
  levelTriangles(): [number, number, number, number] {
    return [...this.numbers(this.of.level_triangles(), 4)] as [number, number, number, number];
  }
  /** The least position on each axis, and the largest. */
  bounds(): { min: [number, number, number]; max: [number, number, number] } {
    const [a, b, c, d, e, f] = this.numbers(this.of.bounds(), 6) as unknown as number[] & { length: 6 };
    return { min: [a!, b!, c!], max: [d!, e!, f!] };
  }
  /** The bytes of all vertices. */
  attribute(place: number, bytes: number): ArrayBuffer {
    return this.copy(this.of.attribute(place), bytes);
  }

  private copy(address: number, bytes: number): ArrayBuffer {
    return this.of.memory.buffer.slice(address, address + bytes);
  }
  private numbers(address: number, count: number): Uint32Array {
    return new Uint32Array(this.of.memory.buffer, address, count);
  }
  private words(address: number): string {
    const memory = new Uint8Array(this.of.memory.buffer);
    return new TextDecoder().decode(memory.subarray(address, memory.indexOf(0, address)));
  }
}
