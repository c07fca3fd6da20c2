// From where a camera sees what matters of some points beside what covers the picture.
import { Vector3, type PerspectiveCamera } from 'three';

/** The covered margins along the picture's edges, pixels. */
export interface Margins {
  readonly top: number;
  readonly right: number;
  readonly bottom: number;
  readonly left: number;
}

/** Puts the middle of what is free of `width` x `height` pixels at what the camera looks at. */
export function putInTheMiddle(
  camera: PerspectiveCamera,
  { top, right, bottom, left }: Margins,
  width: number,
  height: number,
): void {
  camera.setViewOffset(width, height, (right - left) / 2, (bottom - top) / 2, width, height);
}

/** Part of the picture that stays free around the points. */
const margin = 0.08;
/** Part of the points that may lie beyond the borders, on each axis: drops that fly far. */
const beyond = 0.02;
/** Those that are no farther beyond than this part of the extent of the others are seen, too. */
const close = 0.15;
/** Each brings the picture closer to the borders; after the last it is right to a pixel or two. */
const rounds = 6;

/** Of a mesh without extent; world units. */
const nearest = 1e-6;

export interface Framing {
  readonly target: Vector3;
  /** From the target to the camera. */
  readonly distance: number;
}

/**
 * Has 98 % of the points on each axis of the picture, as large as they can be, and in the middle.
 * points: some at least. all: points that must all be seen. direction: from the target to the camera, of length 1, not straight up.
 * free: parts of the picture's width and height.
 */
export function framing(
  points: readonly Vector3[],
  all: readonly Vector3[],
  direction: Vector3,
  { fov, aspect }: Pick<PerspectiveCamera, 'fov' | 'aspect'>,
  free: { readonly width: number; readonly height: number },
): Framing {
  const right = new Vector3(0, 1, 0).cross(direction).normalize();
  const up = direction.clone().cross(right);
  const half = Math.tan((fov * Math.PI) / 360) * (1 - margin);
  const tall = half * free.height;
  const wide = half * aspect * free.width;
  const along = (axis: Vector3): readonly [low: number, high: number] =>
    extent(
      points.map((point) => point.dot(axis)),
      all.map((point) => point.dot(axis)),
    );
  const middleOf = ([low, high]: readonly [number, number]): number => (low + high) / 2;
  const [across, above, towards] = [along(right), along(up), along(direction)];
  let [x, y] = [middleOf(across), middleOf(above)];
  const z = middleOf(towards);
  const depth = (towards[1] - towards[0]) / 2;
  let distance = nearest + depth + Math.max((across[1] - across[0]) / 2 / wide, (above[1] - above[0]) / 2 / tall);
  for (let round = 0; round < rounds; ++round) {
    // Slopes from the line of sight: where a point is seen.
    const seen = (axis: Vector3, middle: number): readonly [number, number] => {
      const slope = (point: Vector3): number =>
        (point.dot(axis) - middle) / Math.max(distance - (point.dot(direction) - z), 1e-3 * distance);
      return extent(points.map(slope), all.map(slope));
    };
    const [horizontal, vertical] = [seen(right, x), seen(up, y)];
    x += middleOf(horizontal) * distance;
    y += middleOf(vertical) * distance;
    const fill = Math.max((horizontal[1] - horizontal[0]) / 2 / wide, (vertical[1] - vertical[0]) / 2 / tall);
    // As the nearest of them need it, which grow the fastest.
    distance = Math.max(depth + (distance - depth) * fill, depth * 1.05, nearest);
  }
  const target = new Vector3().addScaledVector(right, x).addScaledVector(up, y).addScaledVector(direction, z);
  return { target, distance };
}

/** The shortest that holds most of the first ones, all of the others, and what is close to it. */
function extent(most: number[], all: number[]): readonly [low: number, high: number] {
  const sorted = Float64Array.from(most).sort();
  const [least, greatest] = [sorted[0]!, sorted[sorted.length - 1]!];
  const out = Math.floor(beyond * sorted.length);
  const within = (from: number): readonly [number, number] => [sorted[from]!, sorted[sorted.length - 1 - out + from]!];
  let [low, high] = within(0);
  for (let from = 1; from <= out; ++from) {
    const [start, end] = within(from);
    if (end - start < high - low) [low, high] = [start, end];
  }
  const room = close * (high - low);
  return [Math.min(Math.max(least, low - room), ...all), Math.max(Math.min(greatest, high + room), ...all)];
}
