// The counts in a Draco mesh's header, compared with the announced ones before Draco allocates by them.
import type { EncodedBrick } from '../bricks/frame';
import { maxBrickTriangles } from '../bricks/lattice';

/** Magic word, version 2.2, triangular mesh (1), edgebreaker (1), no flags: Draco's bitstream specification, section 3. */
const expected = [0x44, 0x52, 0x41, 0x43, 0x4f, 2, 2, 1, 1, 0, 0];
/** The smoothest surface takes an eighth of a byte per triangle. */
const mostTrianglesPerByte = 64;

/** Throws an Error. */
export function requirePlausible({ triangleCount, data, attributes }: EncodedBrick): void {
  if (triangleCount > maxBrickTriangles)
    throw new Error(`${triangleCount} triangles are announced; a brick has at most ${maxBrickTriangles}`);
  if (triangleCount > mostTrianglesPerByte * data.length)
    throw new Error(
      `${triangleCount} triangles are announced in ${data.length} bytes, more than ${mostTrianglesPerByte} per byte`,
    );
  if (!expected.every((byte, i) => data[i] === byte))
    throw new Error('its bytes are not a Draco mesh as bricks have them');
  const cursor = new Cursor(data, expected.length + 1);
  const vertices = cursor.number();
  const faces = cursor.number();
  const connectivities = cursor.number();
  const symbols = cursor.number();
  const splits = cursor.number();
  if (faces !== triangleCount) throw new Error(`it has ${faces} triangles; announced were ${triangleCount}`);
  if (!(vertices <= 3 * faces && symbols <= faces && splits <= symbols && connectivities <= 1 + attributes.length))
    throw new Error(
      `its Draco mesh has ${vertices} vertices, ${symbols} symbols and ${splits} splits, which do not fit ${faces} triangles`,
    );
}

class Cursor {
  constructor(
    private readonly bytes: Uint8Array,
    private at: number,
  ) {}

  /** Seven bits a byte, the lowest first, of at most 32 bits; NaN where the bytes end. */
  number(): number {
    let value = 0;
    for (let scale = 1; scale < 2 ** 35; scale *= 128) {
      const byte = this.bytes[this.at++];
      if (byte === undefined) return NaN;
      value += (byte & 0x7f) * scale;
      if (byte < 0x80) return value;
    }
    return NaN;
  }
}
