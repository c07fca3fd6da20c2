// The scene is y-up; a simulation may have another axis up, and be far from the origin.
import { Matrix4, Vector3, type Object3D } from 'three';
import type { Point } from './bounds';

export const axes = ['x', 'y', 'z'] as const;
export type Axis = (typeof axes)[number];
export type UpAxis = Axis;

export function isAxis(text: string): text is Axis {
  return (axes as readonly string[]).includes(text);
}

/** A vector of length 1, in world axes. */
export function alongAxis(axis: Axis): Point {
  return axes.map((each) => (each === axis ? 1 : 0)) as Point;
}

/** Turns an object in world axes to the scene's. */
export function turnUp(object: Object3D, up: UpAxis): void {
  const [x, y, z] = axes.map((axis) => toScene(alongAxis(axis), [0, 0, 0], up)) as [Vector3, Vector3, Vector3];
  object.quaternion.setFromRotationMatrix(new Matrix4().makeBasis(x, y, z));
}

/** origin: the scene's, world units. */
export function toScene(point: Point, origin: Point, up: UpAxis): Vector3 {
  const [x, y, z] = [point[0] - origin[0], point[1] - origin[1], point[2] - origin[2]];
  switch (up) {
    case 'x':
      return new Vector3(z, x, y);
    case 'y':
      return new Vector3(x, y, z);
    case 'z':
      return new Vector3(x, z, -y);
  }
}

export function toWorld(place: Vector3, origin: Point, up: UpAxis): Point {
  const { x, y, z } = place;
  const point: Point = up === 'x' ? [y, z, x] : up === 'y' ? [x, y, z] : [x, -z, y];
  return [point[0] + origin[0], point[1] + origin[1], point[2] + origin[2]];
}
