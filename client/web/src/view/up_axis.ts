// The scene is y-up; a simulation may be z-up, and far from the origin.
import { Vector3, type Object3D } from 'three';
import type { Point } from './bounds';

export type UpAxis = 'y' | 'z';

/** Turns an object in world axes to the scene's. */
export function turnUp(object: Object3D, up: UpAxis): void {
  object.rotation.set(up === 'z' ? -Math.PI / 2 : 0, 0, 0);
}

/** origin: the scene's, world units. */
export function toScene(point: Point, origin: Point, up: UpAxis): Vector3 {
  const [x, y, z] = [point[0] - origin[0], point[1] - origin[1], point[2] - origin[2]];
  return up === 'y' ? new Vector3(x, y, z) : new Vector3(x, z, -y);
}

export function toWorld(place: Vector3, origin: Point, up: UpAxis): Point {
  const [x, y, z] = up === 'y' ? [place.x, place.y, place.z] : [place.x, -place.z, place.y];
  return [x + origin[0], y + origin[1], z + origin[2]];
}
