// Where a pointer is over a picture, and where it has tapped: a press that did not turn the camera.

/** CSS pixels, of the canvas. */
export type Spot = readonly [number, number];

export interface PointerEvents {
  over(spot: Spot): void;
  tapped(spot: Spot): void;
}

/** CSS pixels that a finger may move without dragging. */
const steady = 5;

export function followPointer(canvas: HTMLElement, events: PointerEvents): void {
  let pressed: Spot | undefined;
  canvas.addEventListener('pointermove', (event) => {
    if (event.buttons === 0) events.over(spotOf(event));
  });
  canvas.addEventListener('pointerdown', (event) => {
    // Two fingers do not tap.
    pressed = event.isPrimary && event.button === 0 ? spotOf(event) : undefined;
  });
  canvas.addEventListener('pointerup', (event) => {
    const spot = spotOf(event);
    if (pressed && Math.hypot(spot[0] - pressed[0], spot[1] - pressed[1]) <= steady) events.tapped(spot);
    pressed = undefined;
  });
}

function spotOf(event: PointerEvent): Spot {
  return [event.offsetX, event.offsetY];
}
