import { describe, expect, it } from 'vitest';
import type { Point } from '../src/view/bounds';
import { cutPlane, depthInKept, sideTowards, type Cut } from '../src/view/cut';
import { axes, toScene } from '../src/view/up_axis';

const cuts = axes.flatMap((axis) => (['beyond', 'before'] as const).map((away): Cut => ({ axis, at: 1000.25, away })));

describe('a cut', () => {
  it('takes away what lies beyond it, or before it', () => {
    expect(depthInKept({ axis: 'y', at: 2, away: 'beyond' }, [9, 1.5, 9])).toBe(0.5);
    expect(depthInKept({ axis: 'y', at: 2, away: 'before' }, [9, 1.5, 9])).toBe(-0.5);
  });

  it.each(cuts)('is the same plane in the scene, whatever is up and wherever the origin lies: $axis $away', (cut) => {
    const origin: Point = [1e3, 998, 1003];
    const point: Point = [1000, 1001, 1000.75];
    for (const up of axes)
      expect(cutPlane(cut, origin, up).distanceToPoint(toScene(point, origin, up))).toBeCloseTo(
        depthInKept(cut, point),
        12,
      );
  });

  it('is seen from where the camera is', () => {
    const camera: Point = [5, -5, 0];
    for (const axis of ['x', 'y'] as const) {
      const cut: Cut = { axis, at: 1, away: sideTowards(camera, axis, 1) };
      expect(depthInKept(cut, camera)).toBeLessThan(0);
    }
  });
});
