// The axes of the coordinates, as they lie in the picture.
import { Vector3, type Quaternion } from 'three';
import { drawLine, drawText, type Pen } from './pen';
import { alongAxis, axes, toScene, type Axis, type UpAxis } from './up_axis';

/** CSS pixels. */
const arm = 24;
const toLetter = 33;

/** Vermilion, green, blue: the color-blind can distinguish them, too. */
const colors: Record<Axis, string> = { x: '#d4471c', y: '#1b8f5a', z: '#2f74d0' };

/** Where an axis points in the picture: right, down, and towards the eye. turn: the camera's, in the scene. */
export function axisInPicture(axis: Axis, up: UpAxis, turn: Quaternion): Vector3 {
  const direction = toScene(alongAxis(axis), [0, 0, 0], up).applyQuaternion(turn.clone().invert());
  return direction.setY(-direction.y);
}

/** The one that points away most is drawn first. */
export function drawAxes(pen: Pen, [x, y]: readonly [number, number], up: UpAxis, turn: Quaternion): void {
  axes
    .map((axis) => ({ axis, to: axisInPicture(axis, up, turn) }))
    .sort((a, b) => a.to.z - b.to.z)
    .forEach(({ axis, to }) => {
      const colored = { ...pen, color: colors[axis] };
      drawLine(colored, [
        [x, y],
        [x + arm * to.x, y + arm * to.y],
      ]);
      drawText(pen, axis.toUpperCase(), [x + toLetter * to.x, y + toLetter * to.y]);
    });
}
