import { PerspectiveCamera, Vector3 } from 'three';
import { describe, expect, it } from 'vitest';
import { roundLength, scaleBar, worldPerPixel } from '../src/view/scale_bar';

describe('the scale bar', () => {
  it('has a length of 1, 2 or 5 times a power of ten, the longest that is allowed', () => {
    expect([1, 1.99, 2, 4.99, 5, 9.99, 10].map(roundLength)).toEqual([1, 1, 2, 2, 5, 5, 10]);
    expect([0.001, 0.0021, 0.3, 1000, 4999].map(roundLength)).toEqual([0.001, 0.002, 0.2, 1000, 2000]);
  });

  it('is written with its one digit at any scale', () => {
    for (let exponent = -9; exponent <= 9; ++exponent)
      for (const digit of [1, 2, 5]) {
        const length = Number(`${digit}e${exponent}`);
        expect(roundLength(length)).toBe(length);
        expect(roundLength(length * 1.001)).toBe(length);
        expect(String(length)).toMatch(/^[0.]*[125]0*(e-\d+)?$/);
      }
  });

  it('is as wide as its length is where the camera looks', () => {
    const camera = new PerspectiveCamera(40, 1.5, 0.01, 100);
    camera.position.set(3, 4, 12);
    camera.lookAt(0, 0, 0);
    camera.updateMatrixWorld();
    const { length, pixels } = scaleBar(worldPerPixel(13, camera.fov, 600));
    const right = new Vector3(1, 0, 0).applyQuaternion(camera.quaternion).multiplyScalar(length);
    expect((right.project(camera).x / 2) * 900).toBeCloseTo(pixels, 9);
    expect(pixels).toBeGreaterThan(120 / 2.5);
    expect(pixels).toBeLessThanOrEqual(120);
  });
});
