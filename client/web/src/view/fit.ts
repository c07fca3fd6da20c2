// From where a camera sees all of some points beside what covers the picture.
import { Vector3, type PerspectiveCamera } from 'three';

/** The covered margins along the picture's edges, pixels. */
export interface Margins {
  readonly top: number;
  readonly right: number;
  readonly bottom: number;
}

/** Puts the middle of what is free of `width` x `height` pixels at what the camera looks at. */
export function putInTheMiddle(
  camera: PerspectiveCamera,
  { top, right, bottom }: Margins,
  width: number,
  height: number,
): void {
  camera.setViewOffset(width, height, right / 2, (bottom - top) / 2, width, height);
}

/** Part of the picture that stays free around the points. */
const margin = 0.08;

/**
 * From the point that the camera looks at. points: relative to that one. direction: from it to the camera, of length 1, not straight up.
 * free: parts of the picture's width and height.
 */
export function distanceToSee(
  points: readonly Vector3[],
  direction: Vector3,
  { fov, aspect }: Pick<PerspectiveCamera, 'fov' | 'aspect'>,
  free: { readonly width: number; readonly height: number },
): number {
  const right = new Vector3(0, 1, 0).cross(direction).normalize();
  const up = direction.clone().cross(right);
  const half = Math.tan((fov * Math.PI) / 360) * (1 - margin);
  const tall = half * free.height;
  const wide = half * aspect * free.width;
  return Math.max(
    ...points.map(
      (point) => point.dot(direction) + Math.max(Math.abs(point.dot(right)) / wide, Math.abs(point.dot(up)) / tall),
    ),
  );
}
