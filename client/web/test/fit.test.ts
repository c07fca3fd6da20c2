import { PerspectiveCamera, Vector3 } from 'three';
import { describe, expect, it } from 'vitest';
import { contains, corners, union, type WorldBox } from '../src/view/bounds';
import { framing, putInTheMiddle, type Margins } from '../src/view/fit';

const box: WorldBox = { min: [-3, -0.5, -1], max: [3, 0.5, 1] };
const direction = new Vector3(0.55, 0.4, 1).normalize();

const ends = corners(box).map((corner) => new Vector3(...corner));
/** Points all over the box. */
const filling = Array.from(
  { length: 9 ** 3 },
  (_, i) =>
    new Vector3(
      ...[i % 9, Math.floor(i / 9) % 9, Math.floor(i / 81)].map((n, axis) => {
        const [low, high] = [box.min[axis]!, box.max[axis]!];
        return low + (n / 8) * (high - low);
      }),
    ),
);

describe('framing', () => {
  const [width, height] = [1000, 500];
  const camera = new PerspectiveCamera(40, width / height, 0.01, 100);

  /** Pixels from the borders of what is free: left, right, top, bottom. */
  function away(
    points: readonly Vector3[],
    seen: readonly Vector3[],
    all: readonly Vector3[],
    margins: Margins,
  ): number[] {
    const { top, right, bottom, left } = margins;
    const free = { width: 1 - (left + right) / width, height: 1 - (top + bottom) / height };
    const { target, distance } = framing(points, all, direction, camera, free);
    camera.position.copy(target).addScaledVector(direction, distance);
    putInTheMiddle(camera, margins, width, height);
    camera.lookAt(target);
    camera.updateMatrixWorld();
    const places = seen.map((point) => point.clone().project(camera));
    const [xs, ys] = [places.map(({ x }) => ((x + 1) / 2) * width), places.map(({ y }) => ((1 - y) / 2) * height)];
    return [
      Math.min(...xs) - left,
      width - right - Math.max(...xs),
      Math.min(...ys) - top,
      height - bottom - Math.max(...ys),
    ];
  }

  it.each([
    { top: 0, right: 0, bottom: 0, left: 0 },
    { top: 0, right: 300, bottom: 80, left: 0 },
    { top: 0, right: 200, bottom: 80, left: 250 },
    { top: 120, right: 0, bottom: 60, left: 0 },
  ])('has all points in what is free of the picture, in its middle, close to its borders: %o', (margins) => {
    const [left, right, top, bottom] = away(ends, ends, [], margins) as [number, number, number, number];
    expect(Math.min(left, right, top, bottom)).toBeGreaterThan(0);
    expect(Math.min(left, right, top, bottom)).toBeLessThan(50);
    expect(Math.abs(left - right)).toBeLessThan(2);
    expect(Math.abs(top - bottom)).toBeLessThan(2);
  });

  const none = { top: 0, right: 0, bottom: 0, left: 0 };
  it('does not let a few that are far away make the others small', () => {
    const few = [new Vector3(0, 40, 0), new Vector3(60, 0, 0)];
    const [left, right, top, bottom] = away([...filling, ...few], ends, [], none) as [number, number, number, number];
    expect(Math.min(left, right, top, bottom)).toBeGreaterThan(-0.1 * height);
    expect(width - left - right).toBeGreaterThan(0.6 * width);
  });

  it('has those in view that must be, and finds a distance for a single point', () => {
    const must = [new Vector3(0, 8, 0)];
    expect(Math.min(...away(filling, must, must, none))).toBeGreaterThan(0);
    expect(framing([new Vector3(1, 2, 3)], [], direction, camera, { width: 1, height: 1 }).distance).toBeGreaterThan(0);
  });
});

describe('boxes', () => {
  it('contain what lies in them, and become larger by what does not', () => {
    const other: WorldBox = { min: [0, 0, 0], max: [1, 2, 0.5] };
    expect([contains(box, box), contains(box, other), contains(union(box, other), other)]).toEqual([true, false, true]);
    expect(union(box, other)).toEqual({ min: [-3, -0.5, -1], max: [3, 2, 1] });
  });
});
