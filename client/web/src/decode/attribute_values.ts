// The values of one attribute of a brick, as its bytes have them and as they are meant.
import type { CodedAttribute } from '../bricks/attributes';

export type AttributeArray = Float32Array | Uint8Array | Int32Array | Uint32Array;

export interface DecodedAttribute {
  readonly name: string;
  /** Numbers per point. */
  readonly components: number;
  /** One point after the other; whole numbers in arrays of their type. */
  readonly values: AttributeArray;
}

interface Stored {
  readonly type: 'uint8' | 'uint16' | 'float32';
  /** Numbers of that type per point. */
  readonly components: number;
  /** Per number. */
  readonly bytes: number;
  of(buffer: ArrayBuffer): AttributeArray | Uint16Array;
}

/** How bricks have it. An id is its four bytes, little-endian as browsers' machines are, since Draco cannot hold every number of its type. */
export function storedAs({ type, bits, components }: CodedAttribute): Stored {
  const uint8: Stored = { type: 'uint8', components, bytes: 1, of: (buffer) => new Uint8Array(buffer) };
  if (bits > 8) return { type: 'uint16', components, bytes: 2, of: (buffer) => new Uint16Array(buffer) };
  if (bits > 0) return uint8;
  switch (type) {
    case 'float32':
      return { type: 'float32', components, bytes: 4, of: (buffer) => new Float32Array(buffer) };
    case 'uint8':
      return uint8;
    case 'int32':
      return { ...uint8, components: 4, of: (buffer) => new Int32Array(buffer) };
    case 'uint32':
      return { ...uint8, components: 4, of: (buffer) => new Uint32Array(buffer) };
  }
}

/** Throws an Error where a number is beyond its bits, or no number. */
export function valuesOf(stored: AttributeArray | Uint16Array, form: CodedAttribute): AttributeArray {
  const { name, bits, components, minimum, maximum } = form;
  if (bits === 0) {
    if (stored instanceof Float32Array && !stored.every(Number.isFinite))
      throw new Error(`its attribute ${name} is not finite`);
    return stored as AttributeArray;
  }
  if (minimum.length !== components) throw new Error(`its attribute ${name} was announced without a range`);
  const last = 2 ** bits - 1;
  const values = new Float32Array(stored.length);
  for (let component = 0; component < components; ++component) {
    const low = minimum[component]!;
    const extent = maximum[component]! - low;
    for (let i = component; i < stored.length; i += components) {
      const q = stored[i]!;
      if (q > last) throw new Error(`its attribute ${name} has the number ${q}, which is beyond ${bits} bits`);
      values[i] = low + (q * extent) / last;
    }
  }
  return values;
}
