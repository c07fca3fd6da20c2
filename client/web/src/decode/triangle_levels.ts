// A triangle's level, from the places of its vertices: a crack triangle lies in a face plane of the base-cell grid, any other inside one
// base cell, whose level is its own.
import { baseCellSize, brickBaseCells } from '../bricks/lattice';

const cellsPerBrick = brickBaseCells ** 3;
const noCell = 0xffff;
/** The group of crack triangles, behind those of levels 1 to 3. */
const crackGroup = 3;

/** For every triangle the index of its group: 0, 1, 2 for levels 1, 2, 3; 3 for crack filling. Throws if the bytes do not fit. */
export function triangleGroups(
  positions: Uint16Array,
  stride: number,
  triangles: Uint32Array,
  packedLevels: Uint8Array,
  offsetBits: number,
): Uint8Array {
  const edge = baseCellSize << offsetBits;
  const count = triangles.length / 3;
  const cells = new Uint16Array(count);
  const levels = new Uint8Array(cellsPerBrick);
  for (let t = 0; t < count; ++t) {
    const cell = cellOfTriangle(
      positions,
      triangles[3 * t]! * stride,
      triangles[3 * t + 1]! * stride,
      triangles[3 * t + 2]! * stride,
      edge,
    );
    cells[t] = cell;
    if (cell !== noCell) levels[cell] = 1;
  }
  unpackLevels(packedLevels, levels);
  const groups = new Uint8Array(count);
  for (let t = 0; t < count; ++t) groups[t] = cells[t] === noCell ? crackGroup : levels[cells[t]!]! - 1;
  return groups;
}

/** x + 16 y + 256 z of the base cell; noCell for a crack triangle. a, b, c: where the corners begin in `positions`. */
function cellOfTriangle(positions: Uint16Array, a: number, b: number, c: number, edge: number): number {
  let cell = 0;
  for (let axis = 0; axis < 3; ++axis) {
    const pa = positions[a + axis]!;
    const pb = positions[b + axis]!;
    const pc = positions[c + axis]!;
    if (pa === pb && pb === pc && pa % edge === 0) return noCell;
    cell |= Math.min(Math.floor(Math.min(pa, pb, pc) / edge), brickBaseCells - 1) << (4 * axis);
  }
  return cell;
}

/** Replaces the marks of cells that hold triangles by the cells' levels: two bits each, in the order of the cells. */
function unpackLevels(packed: Uint8Array, levels: Uint8Array): void {
  let at = 0;
  for (let cell = 0; cell < cellsPerBrick; ++cell) {
    if (levels[cell] === 0) continue;
    const level = ((packed[at >> 2] ?? 0) >> (2 * (at & 3))) & 3;
    if (level === 0 && at >> 2 < packed.length) throw new Error('a base cell has the level 0; it must be 1 to 3');
    levels[cell] = level;
    ++at;
  }
  if (packed.length !== (at + 3) >> 2)
    throw new Error(`there are ${packed.length} bytes of cell levels, but ${at} base cells with triangles`);
}
