// Orbit, pan and zoom by mouse, touch and keyboard; says when the camera moves and when it rests.
import { PerspectiveCamera, Vector3 } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';

/** ms without movement after which the camera rests. */
const restAfter = 200;
/** Radians and pixels per key press. */
const turn = Math.PI / 24;
const shift = 24;
const zoom = 0.9;

export interface CameraEvents {
  changed(): void;
  moving(moving: boolean): void;
}

export class CameraControls {
  readonly camera = new PerspectiveCamera(40, 1, 0.01, 100);
  private readonly orbit: OrbitControls;
  private rest: ReturnType<typeof setTimeout> | undefined;

  constructor(
    canvas: HTMLElement,
    private readonly events: CameraEvents,
  ) {
    this.orbit = new OrbitControls(this.camera, canvas);
    this.orbit.zoomToCursor = true;
    this.orbit.addEventListener('change', () => {
      this.events.changed();
    });
    // Only what a person does moves the camera in the sense of the stream: fitting does not.
    this.orbit.addEventListener('start', () => {
      this.moved();
    });
    canvas.addEventListener('pointermove', (event) => {
      if (event.buttons !== 0) this.moved();
    });
    canvas.addEventListener(
      'wheel',
      () => {
        this.moved();
      },
      { passive: true },
    );
  }

  get target(): Vector3 {
    return this.orbit.target;
  }

  place(position: Vector3, target: Vector3): void {
    this.camera.position.copy(position);
    this.orbit.target.copy(target);
    this.orbit.update();
  }

  /** sceneSize: for planes before and behind everything, wherever the camera goes. */
  setReach(sceneSize: number): void {
    this.camera.near = sceneSize / 500;
    this.camera.far = sceneSize * 50;
    this.orbit.minDistance = sceneSize / 100;
    this.orbit.maxDistance = sceneSize * 10;
    this.camera.updateProjectionMatrix();
  }

  /** By an arrow key, in its direction. */
  turn(key: string): void {
    if (key === 'ArrowLeft') this.orbit.rotateLeft(-turn);
    else if (key === 'ArrowRight') this.orbit.rotateLeft(turn);
    else if (key === 'ArrowUp') this.orbit.rotateUp(turn);
    else this.orbit.rotateUp(-turn);
    this.moved();
  }

  /** By an arrow key, in its direction. */
  shift(key: string): void {
    if (key === 'ArrowLeft') this.orbit.pan(shift, 0);
    else if (key === 'ArrowRight') this.orbit.pan(-shift, 0);
    else if (key === 'ArrowUp') this.orbit.pan(0, shift);
    else this.orbit.pan(0, -shift);
    this.moved();
  }

  /** By minus, out; by any other, in. */
  zoom(key: string): void {
    if (key === '-') this.orbit.dollyOut(zoom);
    else this.orbit.dollyIn(zoom);
    this.moved();
  }

  private moved(): void {
    this.events.moving(true);
    clearTimeout(this.rest);
    this.rest = setTimeout(() => {
      this.events.moving(false);
    }, restAfter);
  }
}
