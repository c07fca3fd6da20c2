// The camera that keeps the water in view as it moves and spreads, until a person moves it.
import { Vector3 } from 'three';
import { contains, union, type Point, type WorldBox } from './bounds';
import type { CameraControls } from './camera_controls';
import { apart, lengthOf, samePlace, type CameraPlace } from './camera_place';
import { framing, type Margins } from './fit';

/** The points that a picture has to show, in the scene. */
export interface Sight {
  /** All but a few of them. */
  readonly points: readonly Vector3[];
  /** Each of these, too. */
  readonly all: readonly Vector3[];
  /** CSS pixels of the picture. */
  readonly width: number;
  readonly height: number;
  readonly covered: Margins;
}

/** The scene that the camera is in. */
export interface CameraScene {
  inScene(point: Point): Vector3;
  inWorld(place: Vector3): Point;
  /** The scene is to be laid out around this box. The camera stays where it is in the world. */
  adopt(box: WorldBox): void;
  sight(): Sight;
  draw(): void;
}

/** From the mesh to a camera that looks at all of it; of a picture that is taller than wide from higher up, so that there is less sky. */
const fitDirection = new Vector3(0.55, 0.32, 1).normalize();
const fitDirectionTall = new Vector3(0.55, 0.7, 1).normalize();
/** ms after which the camera has come two thirds of its way to where the water has gone. */
const easing = 220;
/** Parts of the distance: the water may move so far before the camera follows, and so close the camera comes. */
const slack = 0.04;
const arrived = 0.005;
/** ms after which a picture is not the one before the next. */
const pictureRests = 1000;

/** Whether a person wants no movement that no hand has made. */
const calm = matchMedia('(prefers-reduced-motion: reduce)');

export class FollowingCamera {
  /** Around the meshes that the camera has followed, until a person moves it. */
  private following: WorldBox | undefined;
  /** From the water to the camera that follows it, in the scene; none: that of fit(). */
  private direction: Vector3 | undefined;
  /** The place that the camera that follows is on its way to. */
  private goal: CameraPlace | undefined;
  /** The time of the last picture, ms. */
  private drawnAt = -Infinity;

  constructor(
    private readonly controls: CameraControls,
    private readonly scene: CameraScene,
  ) {}

  get follows(): boolean {
    return this.following !== undefined;
  }

  get place(): CameraPlace {
    return {
      position: this.scene.inWorld(this.controls.camera.position),
      target: this.scene.inWorld(this.controls.target),
    };
  }

  /** Does not change whether it follows. */
  moveTo({ position, target }: CameraPlace): void {
    this.controls.place(this.scene.inScene(position), this.scene.inScene(target));
  }

  /** It does not follow any more. */
  stay(): void {
    this.following = undefined;
    this.goal = undefined;
  }

  /** Stays above the middle of the scene, which is empty. */
  lookAtNothing(): void {
    this.stay();
    this.controls.place(fitDirection.clone().multiplyScalar(2), new Vector3());
  }

  /** Looks at all of it, at once, and follows it from now on. box: around it; none: there is nothing yet. */
  fit(box: WorldBox | undefined): void {
    this.lookFrom(undefined, box);
  }

  /** The same, from this direction, of length 1, in the scene; from there, from the opposite one. */
  lookAlong(direction: Vector3, box: WorldBox | undefined): void {
    const from = direction.clone();
    if (this.following && this.direction && this.direction.dot(from) > 0.99) from.negate();
    // A view straight up or down has no right and left.
    if (from.y !== 0) from.z += 1e-3;
    this.lookFrom(from.normalize(), box);
  }

  private lookFrom(direction: Vector3 | undefined, box: WorldBox | undefined): void {
    this.direction = direction;
    if (!box) return;
    this.following = box;
    this.scene.adopt(box);
    this.lookAgain();
  }

  /** Goes at once to where it follows from, if it follows: the picture has another size. */
  lookAgain(): void {
    const place = this.following && this.placeToSee();
    if (!place) return;
    this.goal = place;
    this.moveTo(place);
    this.scene.draw();
  }

  /** The camera goes with the water that it shows. box: around the water now. */
  follow(box: WorldBox | undefined): void {
    if (!box || !this.following) return;
    if (!contains(this.following, box)) {
      this.following = union(this.following, box);
      this.scene.adopt(this.following);
    }
    const place = this.placeToSee();
    if (this.goal && place && apart(place, this.goal) < slack * lengthOf(place)) return;
    this.goal = place;
  }

  /** With each picture: a step of its way, if it is not there yet. now: ms. */
  step(now: number): void {
    const { goal, place } = this;
    const since = now - this.drawnAt;
    this.drawnAt = now;
    if (!goal || samePlace(goal, place)) return;
    // Where pictures take long the camera jumps: none is drawn for its way alone.
    const part = calm.matches ? 1 : 1 - Math.exp(-(since < pictureRests ? since : 16) / easing);
    const near = (1 - part) * apart(goal, place) <= arrived * lengthOf(goal);
    const between = (from: Point, to: Point): Vector3 =>
      this.scene.inScene(from).lerp(this.scene.inScene(to), near ? 1 : part);
    this.controls.place(between(place.position, goal.position), between(place.target, goal.target));
    if (!near) this.scene.draw();
  }

  /** The place from which the mesh is seen, beside the panels that cover the picture; none where there is no mesh. */
  private placeToSee(): CameraPlace | undefined {
    const { points, all, width, height, covered } = this.scene.sight();
    if (points.length + all.length === 0 || width === 0 || height === 0) return undefined;
    const { top, right, bottom, left } = covered;
    const free = {
      width: Math.max(0.2, 1 - (left + right) / width),
      height: Math.max(0.2, 1 - (top + bottom) / height),
    };
    const direction =
      this.direction ?? (free.width * width < 0.8 * free.height * height ? fitDirectionTall : fitDirection);
    const { camera } = this.controls;
    const { target, distance } = framing(points.length > 0 ? points : all, all, direction, camera, free);
    return {
      position: this.scene.inWorld(target.clone().addScaledVector(direction, distance)),
      target: this.scene.inWorld(target),
    };
  }
}
