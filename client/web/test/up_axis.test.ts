import { Group, Vector3 } from 'three';
import { describe, expect, it } from 'vitest';
import type { Point } from '../src/view/bounds';
import { axisInPicture } from '../src/view/axes_gizmo';
import { alongAxis, axes, toScene, toWorld, turnUp } from '../src/view/up_axis';

describe.each(axes)('%s up', (up) => {
  const origin: Point = [1e6, -2, 3];

  it('is up in the scene, which is not mirrored', () => {
    expect(toScene(alongAxis(up), [0, 0, 0], up).y).toBe(1);
    const [x, y, z] = axes.map((axis) => toScene(alongAxis(axis), [0, 0, 0], up)) as [Vector3, Vector3, Vector3];
    expect(x.cross(y).dot(z)).toBe(1);
  });

  it('leads to the scene and back', () => {
    const point: Point = [1e6 + 0.25, 7, -1.5];
    expect(toWorld(toScene(point, origin, up), origin, up)).toEqual(point);
  });

  it('turns objects as it turns points', () => {
    const group = new Group();
    turnUp(group, up);
    const turned = new Vector3(1, 2, 3).applyQuaternion(group.quaternion);
    expect(turned.distanceTo(toScene([1, 2, 3], [0, 0, 0], up))).toBeLessThan(1e-12);
  });

  it('points up in the picture of a camera that looks ahead', () => {
    const { x, y, z } = axisInPicture(up, up, new Group().quaternion);
    expect([x, y, z].map((c) => c + 0)).toEqual([0, -1, 0]);
  });
});
