// The first point that a ray meets: on the surface, or on the face of a cut through it.
import { Box3, Ray, Triangle, Vector3 } from 'three';
import type { Shown, ShownBrick } from '../bricks/brick_store';
import { brickEdge, type Frame } from '../bricks/frame';
import { triangleLevels, type DecodedBrick } from '../decode/decoded_brick';
import type { Point } from './bounds';
import { depthInKept, type Cut } from './cut';

/** World units. */
export interface WorldRay {
  readonly origin: Point;
  /** A direction of length 1. */
  readonly direction: Point;
}

/** A place within a triangle. */
export interface Spot {
  readonly brick: DecodedBrick;
  readonly points: readonly [number, number, number];
  /** The weights of the points; they sum to 1. */
  readonly weights: readonly [number, number, number];
}

export interface Pick {
  /** World units. */
  readonly place: Point;
  /** The level of the triangle; none on the face of a cut. */
  readonly level: (typeof triangleLevels)[number] | undefined;
  /** None on the face of a cut. */
  readonly spot: Spot | undefined;
}

interface Hit {
  /** From the ray's origin, world units. */
  readonly distance: number;
  /** Whether the ray goes into the water here, or out of it. */
  readonly inwards: boolean;
  readonly brick: DecodedBrick;
  readonly triangle: number;
  readonly weights: readonly [number, number, number];
}

export function pick({ frame, bricks }: Shown, ray: WorldRay, cut: Cut | undefined): Pick | undefined {
  const hits = [...bricks.values()].flatMap((brick) => hitsOf(frame, brick, ray));
  const kept = cut ? hits.filter(({ distance }) => depthInKept(cut, at(ray, distance)) >= 0) : hits;
  const face = cut && cutDistance(cut, ray);
  // Within the water if more of what lies behind leads out of it than into it.
  if (face !== undefined && kept.reduce((sum, { inwards }) => sum + (inwards ? -1 : 1), 0) > 0)
    return { place: at(ray, face), level: undefined, spot: undefined };
  const entries = kept.filter(({ inwards }) => inwards);
  if (entries.length === 0) return undefined;
  const first = entries.reduce((a, b) => (b.distance < a.distance ? b : a));
  return { place: at(ray, first.distance), level: levelOf(first), spot: spotOf(first) };
}

function at({ origin, direction }: WorldRay, distance: number): Point {
  return [
    origin[0] + distance * direction[0],
    origin[1] + distance * direction[1],
    origin[2] + distance * direction[2],
  ];
}

/** To the plane, where the ray comes through it into what is kept. */
function cutDistance(cut: Cut, ray: WorldRay): number | undefined {
  const here = depthInKept(cut, ray.origin);
  const distance = here / (here - depthInKept(cut, at(ray, 1)));
  return here < 0 && distance > 0 && Number.isFinite(distance) ? distance : undefined;
}

/** In the brick's own steps, where its points are integers. */
function hitsOf(frame: Frame, { encoded, decoded }: ShownBrick, { origin, direction }: WorldRay): Hit[] {
  const step = frame.cellSize / 2 ** frame.offsetBits;
  const edge = brickEdge(frame);
  const [x, y, z] = encoded.place.map((place, axis) => (origin[axis]! - place * edge) / step) as Point;
  const ray = new Ray(new Vector3(x, y, z), new Vector3(...direction));
  if (!ray.intersectsBox(new Box3(new Vector3(...decoded.bounds.min), new Vector3(...decoded.bounds.max)))) return [];
  const hits: Hit[] = [];
  const { a, b, c } = new Triangle();
  const [met, normal, weights] = [new Vector3(), new Vector3(), new Vector3()];
  for (let i = 0; i < decoded.indices.length; i += 3) {
    for (const [k, corner] of [a, b, c].entries()) corner.fromArray(decoded.positions, 4 * decoded.indices[i + k]!);
    if (!ray.intersectTriangle(a, b, c, false, met)) continue;
    Triangle.getBarycoord(met, a, b, c, weights);
    hits.push({
      distance: met.sub(ray.origin).dot(ray.direction) * step,
      inwards: Triangle.getNormal(a, b, c, normal).dot(ray.direction) < 0,
      brick: decoded,
      triangle: i / 3,
      weights: weights.toArray(),
    });
  }
  return hits;
}

function spotOf({ brick, triangle, weights }: Hit): Spot {
  const [a, b, c] = brick.indices.subarray(3 * triangle, 3 * triangle + 3);
  return { brick, points: [a!, b!, c!], weights };
}

function levelOf({ brick, triangle }: Hit): (typeof triangleLevels)[number] {
  let end = 0;
  return triangleLevels[brick.levelTriangles.findIndex((count) => triangle < (end += count))]!;
}
