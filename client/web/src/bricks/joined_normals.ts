// Computed normals of points that bricks share: each brick has the sums of its own triangles, the normal is that of all.
import { normalOf, placeKey, sumSize } from '../decode/computed_normals';
import type { DecodedBrick, NormalBorder } from '../decode/decoded_brick';
import type { ShownBrick } from './brick_store';
import { brickKey, type BrickKey } from './frame';
import { brickCells } from './lattice';

type Bricks = ReadonlyMap<BrickKey, ShownBrick>;
type Place = readonly [number, number, number];

/**
 * The bricks, of which those have new normals whose own triangles or whose neighbors' have changed so that it shows; all
 * others are the same objects, and so is the map if there are no computed normals to join. before: those of the frame
 * before, which have been joined; from other lattices, too.
 */
export function joinNormals(bricks: Bricks, before: Bricks, offsetBits: number): Bricks {
  const stale = new Set<BrickKey>();
  for (const [key, { encoded, decoded }] of bricks)
    if (decoded.border !== before.get(key)?.decoded.border) addPlacesAround(encoded.place, stale);
  for (const [key, { encoded, decoded }] of before)
    if (decoded.border && !bricks.has(key)) addPlacesAround(encoded.place, stale);
  if (stale.size === 0) return bricks;
  const joined = new Map(bricks);
  for (const key of stale) {
    const brick = bricks.get(key);
    if (brick?.decoded.border) joined.set(key, joinedBrick(brick, brick.decoded.border, bricks, offsetBits));
  }
  return joined;
}

function addPlacesAround([x, y, z]: Place, keys: Set<BrickKey>): void {
  for (let dz = -1; dz <= 1; ++dz)
    for (let dy = -1; dy <= 1; ++dy) for (let dx = -1; dx <= 1; ++dx) keys.add(brickKey(x + dx, y + dy, z + dz));
}

function joinedBrick(brick: ShownBrick, border: NormalBorder, bricks: Bricks, offsetBits: number): ShownBrick {
  const { encoded, decoded } = brick;
  const { positions } = decoded;
  const before = decoded.normals!;
  const neighbors = new Neighbors(encoded.place, bricks, offsetBits);
  const sums = new Float64Array(sumSize);
  let normals = before;
  border.points.forEach((point, i) => {
    sums.set(border.sums.subarray(i * sumSize, (i + 1) * sumSize));
    neighbors.add(positions[4 * point]!, positions[4 * point + 1]!, positions[4 * point + 2]!, sums);
    const [x, y, z] = normalOf(sums, 0);
    const at = 4 * point;
    if (normals[at] === x && normals[at + 1] === y && normals[at + 2] === z) return;
    // Those that are shown stay as they are.
    if (normals === before) normals = before.slice();
    normals.set([x, y, z], at);
  });
  return normals === before ? brick : { encoded, decoded: { ...decoded, normals } };
}

/** Steps along an axis to the bricks that a point is in. */
const within: readonly number[] = [0];
const below: readonly number[] = [0, -1];
const above: readonly number[] = [0, 1];

/** The bricks around one. */
class Neighbors {
  private readonly last: number;
  private readonly found = new Map<number, DecodedBrick | undefined>();

  constructor(
    private readonly place: Place,
    private readonly bricks: Bricks,
    offsetBits: number,
  ) {
    this.last = brickCells << offsetBits;
  }

  /** Adds what they know of a point on the brick's faces. */
  add(x: number, y: number, z: number, sums: Float64Array): void {
    const { last } = this;
    const [beyondX, beyondY, beyondZ] = [this.side(x), this.side(y), this.side(z)];
    // Every way past one, two or three of the faces on which the point lies.
    for (const dx of beyondX)
      for (const dy of beyondY)
        for (const dz of beyondZ) {
          if (dx === 0 && dy === 0 && dz === 0) continue;
          const neighbor = this.at(dx, dy, dz);
          if (!neighbor?.border) continue;
          const key = placeKey(x - dx * last, y - dy * last, z - dz * last);
          const slot = slotsOf(neighbor, neighbor.border).get(key);
          if (slot === undefined) continue;
          for (let k = 0; k < sumSize; ++k) sums[k] = sums[k]! + neighbor.border.sums[slot * sumSize + k]!;
        }
  }

  private side(coordinate: number): readonly number[] {
    return coordinate === 0 ? below : coordinate === this.last ? above : within;
  }

  private at(dx: number, dy: number, dz: number): DecodedBrick | undefined {
    const index = dx + 3 * dy + 9 * dz;
    if (!this.found.has(index)) {
      const [x, y, z] = this.place;
      this.found.set(index, this.bricks.get(brickKey(x + dx, y + dy, z + dz))?.decoded);
    }
    return this.found.get(index);
  }
}

/** The places of points in a border, by where they are; kept for as long as the border is. */
const slots = new WeakMap<NormalBorder, Map<number, number>>();

function slotsOf({ positions }: DecodedBrick, border: NormalBorder): Map<number, number> {
  let known = slots.get(border);
  if (!known) {
    known = new Map();
    for (const [slot, point] of border.points.entries())
      known.set(placeKey(positions[4 * point]!, positions[4 * point + 1]!, positions[4 * point + 2]!), slot);
    slots.set(border, known);
  }
  return known;
}
