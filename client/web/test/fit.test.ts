import { PerspectiveCamera, Vector3 } from 'three';
import { describe, expect, it } from 'vitest';
import { contains, corners, union, type WorldBox } from '../src/view/bounds';
import { distanceToSee, putInTheMiddle } from '../src/view/fit';

const box: WorldBox = { min: [-3, -0.5, -1], max: [3, 0.5, 1] };
const direction = new Vector3(0.55, 0.4, 1).normalize();

describe('distanceToSee', () => {
  const [width, height] = [1000, 500];
  it.each([
    { top: 0, right: 0, bottom: 0 },
    { top: 0, right: 300, bottom: 80 },
    { top: 120, right: 0, bottom: 60 },
  ])('has all points in what is free of the picture, one of them near its border: %o', (margins) => {
    const points = corners(box).map((corner) => new Vector3(...corner));
    const camera = new PerspectiveCamera(40, width / height, 0.01, 100);
    const free = { width: 1 - margins.right / width, height: 1 - (margins.top + margins.bottom) / height };
    camera.position.copy(direction).multiplyScalar(distanceToSee(points, direction, camera, free));
    putInTheMiddle(camera, margins, width, height);
    camera.lookAt(0, 0, 0);
    camera.updateMatrixWorld();
    // Pixels from the borders of what is free.
    const away = points
      .map((point) => point.project(camera))
      .flatMap(({ x, y }) => {
        const [px, py] = [((x + 1) / 2) * width, ((1 - y) / 2) * height];
        return [px, width - margins.right - px, py - margins.top, height - margins.bottom - py];
      });
    expect(Math.min(...away)).toBeGreaterThan(0);
    expect(Math.min(...away)).toBeLessThan(60);
  });
});

describe('boxes', () => {
  it('contain what lies in them, and become larger by what does not', () => {
    const other: WorldBox = { min: [0, 0, 0], max: [1, 2, 0.5] };
    expect([contains(box, box), contains(box, other), contains(union(box, other), other)]).toEqual([true, false, true]);
    expect(union(box, other)).toEqual({ min: [-3, -0.5, -1], max: [3, 2, 1] });
  });
});
