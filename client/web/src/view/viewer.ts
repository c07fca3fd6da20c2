// The picture: scene, camera and looks. Drawn when something has changed, not otherwise.
import { Scene, Vector3, WebGLRenderer, type PerspectiveCamera, type Plane } from 'three';
import type { Shown } from '../bricks/brick_store';
import type { Frame } from '../bricks/frame';
import type { ColorMap } from '../color/color_maps';
import type { Quantity, QuantityKind } from '../color/quantity';
import type { ValueRange } from '../color/value_range';
import type { Particles } from '../particles/particles';
import { Background } from './background';
import { center, contains, corners, size, union, unionOf, worldBox, type Point, type WorldBox } from './bounds';
import { BrickMeshes } from './brick_meshes';
import { CameraControls } from './camera_controls';
import { legendHeight } from './color_legend';
import { ColoredMaterial } from './colored_material';
import { cutPlane, type Cut } from './cut';
import { CutFace } from './cut_face';
import { DomainBox } from './domain_box';
import { environmentUniforms, setTheme, type Theme } from './environment';
import { framing, putInTheMiddle, type Margins } from './fit';
import { levelLineMaterials, levelSurfaceMaterial, plainLineMaterials } from './level_materials';
import { occupied } from './occupied';
import { ParticleCloud } from './particle_cloud';
import { pick, type Pick } from './pick';
import { roundLength } from './scale_bar';
import { SprayCloud } from './spray_cloud';
import { Sunlight } from './sunlight';
import { pictureLayer, ThicknessPass, waterLayer } from './thickness_pass';
import { alongAxis, toScene, toWorld, turnUp, type Axis, type UpAxis } from './up_axis';
import { waterMaterial } from './water_material';

export type Look = 'water' | 'levels';

/** The surface in the colors of what its points have. */
export interface Coloring {
  readonly quantity: Quantity;
  readonly map: ColorMap;
  /** The range of numbers; none without any. */
  readonly range: ValueRange | undefined;
  /** Whether there is no light, so that the colors are those of the map. */
  readonly unlit: boolean;
}

export interface CameraPlace {
  readonly position: Point;
  readonly target: Point;
}

export interface ViewerEvents {
  /** A picture has been drawn, of a frame or of nothing. The canvas can be read until this returns. */
  rendered(): void;
  /** A picture of the frame has been drawn, of its triangles (their number), or of particles. */
  drawn(frame: Frame, triangles: number, particles: Particles | undefined): void;
  moving(moving: boolean): void;
  /** The browser has taken the graphics hardware away, or given it back. */
  lost(lost: boolean): void;
}

/** Pixels of the screen per pixel of the water's thickness, on each axis. */
const thicknessCoarseness = 2;
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
/** Of the mesh's diagonal, at most: the way from one line of the floor to the next. */
const gridPart = 0.15;

/** Whether a person wants no movement that no hand has made. */
const calm = matchMedia('(prefers-reduced-motion: reduce)');

export class Viewer {
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly environment = environmentUniforms();
  private readonly water = waterMaterial(this.environment);
  private readonly levelSurface = levelSurfaceMaterial();
  private readonly coloredMaterials = new Map<QuantityKind, ColoredMaterial>();
  private coloring: Coloring | undefined;
  private readonly background = new Background(this.environment);
  /** One while something is cut away; materials share the array. */
  private readonly cutPlanes: Plane[] = [];
  private readonly cutFace = new CutFace(this.cutPlanes);
  private readonly thickness = new ThicknessPass(this.environment, this.cutPlanes);
  private readonly sunlight = new Sunlight(this.environment, this.cutPlanes);
  private readonly levelLines = levelLineMaterials();
  private readonly plainLines = plainLineMaterials();
  private readonly bricks = new BrickMeshes(this.water, this.levelLines);
  private readonly particles = new ParticleCloud();
  private readonly spray = new SprayCloud();
  private readonly domainBox = new DomainBox();
  readonly controls: CameraControls;
  /** The origin of the scene's coordinates, so that they stay small wherever the water is. */
  private origin: Point = [0, 0, 0];
  private shown: Shown | undefined;
  private look: Look = 'water';
  private up: UpAxis = 'y';
  private cut: Cut | undefined;
  private domain: WorldBox | undefined;
  /** A box to keep in view with the mesh. */
  private beside: WorldBox | undefined;
  private scheduled = false;
  /** Since the last picture. */
  private waterChanged = true;
  /** Around the meshes that the camera has followed, until a person moves it. */
  private following: WorldBox | undefined;
  /** From the water to the camera that follows it, in the scene; none: that of fit(). */
  private direction: Vector3 | undefined;
  /** The place that the camera that follows is on its way to. */
  private goal: CameraPlace | undefined;
  /** The time of the last picture, ms. */
  private drawnAt = -Infinity;

  /** Throws if there is no WebGL 2. */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    /** The margins of the canvas that are covered now. */
    private readonly covered: () => Margins,
    private readonly events: ViewerEvents,
  ) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, stencil: true, powerPreference: 'high-performance' });
    this.renderer.autoClear = false;
    this.renderer.info.autoReset = false;
    this.water.uniforms.thickness.value = this.thickness.texture;
    this.scene.add(this.background.mesh, this.bricks.group);
    this.bricks.group.add(this.particles.points, this.spray.points, this.domainBox.lines);
    for (const material of [
      this.water,
      this.levelSurface,
      ...this.levelLines,
      ...this.plainLines,
      this.particles.material,
      this.spray.material,
    ])
      material.clippingPlanes = this.cutPlanes;
    this.background.mesh.layers.set(pictureLayer);
    this.controls = new CameraControls(canvas, {
      changed: () => {
        this.draw();
      },
      moving: (moving) => {
        this.stay();
        this.events.moving(moving);
      },
    });
    this.controls.camera.layers.enable(pictureLayer);
    new ResizeObserver(() => {
      this.resize();
    }).observe(canvas);
    canvas.addEventListener('webglcontextlost', () => {
      this.events.lost(true);
    });
    canvas.addEventListener('webglcontextrestored', () => {
      this.events.lost(false);
      this.waterChanged = true;
      this.draw();
    });
  }

  /** Back to the empty environment. */
  clear(): void {
    this.shown = undefined;
    this.stay();
    this.beside = undefined;
    this.bricks.clear();
    this.lookAtNothing();
    this.showSpray();
    this.waterChanged = true;
    this.draw();
  }

  show(shown: Shown): void {
    const first = this.shown === undefined || this.shown.bricks.size === 0;
    this.shown = shown;
    const box = worldBox(shown);
    if (first) this.adopt(box);
    else this.bricks.show(shown, this.origin);
    this.showSpray();
    this.waterChanged = true;
    this.follow(box);
    this.draw();
  }

  /** Sets another box to keep in view wherever all of the mesh is. */
  setBeside(box: WorldBox | undefined): void {
    this.beside = box;
    this.setReach();
    this.follow(box);
  }

  /** The camera stays with what is seen of the water, as it goes. */
  private follow(box: WorldBox | undefined): void {
    if (!box || !this.following) return;
    if (!contains(this.following, box)) {
      this.following = union(this.following, box);
      this.adopt(this.following);
    }
    const place = this.placeToSee();
    if (this.goal && place && apart(place, this.goal) < slack * lengthOf(place)) return;
    this.goal = place;
  }

  /** It does not follow any more. */
  private stay(): void {
    this.following = undefined;
    this.goal = undefined;
  }

  /** The floor alone, until there is something. */
  private lookAtNothing(): void {
    this.origin = [0, 0, 0];
    this.environment.floorCenter.value.set(0, 0, 0);
    this.environment.sceneSize.value = 1;
    this.environment.gridOrigin.value.set(0, 0, 0);
    this.environment.gridStep.value = roundLength(gridPart);
    this.controls.place(fitDirection.clone().multiplyScalar(2), new Vector3());
    this.placeInScene();
  }

  /** In place of the surface; its wires stay. None: the surface again. */
  showParticles(particles: Particles | undefined): void {
    this.particles.show(particles, this.origin);
    this.showSpray();
    this.draw();
  }

  /** Where all particles are shown, it is among them. */
  private showSpray(): void {
    this.spray.show(this.particles.shown ? undefined : this.shown?.frame, this.origin);
  }

  setLook(look: Look): void {
    this.look = look;
    this.showLook();
  }

  /** None: water, or the levels' own surface. Bricks that are shown must have been decoded with it. */
  setColoring(coloring: Coloring | undefined): void {
    if (!coloring && !this.coloring) return;
    const { shown } = this;
    if (coloring?.quantity !== this.coloring?.quantity) {
      this.bricks.setQuantity(coloring?.quantity);
      if (shown) this.bricks.show(shown, this.origin);
    }
    const before = this.colored;
    this.coloring = coloring;
    if (coloring) this.coloredMaterial(coloring.quantity.kind).set(coloring.map, coloring.range, coloring.unlit);
    this.showLook();
    // The legend comes, or goes.
    if (this.colored !== before) this.resize();
  }

  /** Whether in place of water there are colors. */
  get colored(): boolean {
    return this.coloring !== undefined && this.particles.shown === undefined;
  }

  /** The covered margins of the canvas, with the legend of the colors. */
  private get margins(): Margins {
    const margins = this.covered();
    return this.colored ? { ...margins, bottom: margins.bottom + legendHeight } : margins;
  }

  private showLook(): void {
    const plain = this.look === 'water' ? this.water : this.levelSurface;
    const material = this.coloring ? this.coloredMaterial(this.coloring.quantity.kind).material : plain;
    const lines = this.coloring ? this.plainLines : this.levelLines;
    this.bricks.setLook(material, this.look === 'levels' ? lines : undefined);
    this.draw();
  }

  /** Made when it is first needed. */
  private coloredMaterial(kind: QuantityKind): ColoredMaterial {
    let made = this.coloredMaterials.get(kind);
    if (!made) {
      made = new ColoredMaterial(kind, this.environment);
      made.material.clippingPlanes = this.cutPlanes;
      this.coloredMaterials.set(kind, made);
    }
    return made;
  }

  setTheme(theme: Theme): void {
    setTheme(this.environment, theme);
    this.levelSurface.uniforms.surfaceColor!.value = theme === 'light' ? [0.93, 0.94, 0.95] : [0.1, 0.12, 0.14];
    this.cutFace.setTheme(theme);
    this.domainBox.setTheme(theme);
    this.draw();
  }

  /** The camera stays where it is, unless it follows the mesh. */
  setUp(up: UpAxis): void {
    if (up === this.up) return;
    const { cameraPlace, following } = this;
    this.up = up;
    turnUp(this.bricks.group, up);
    this.adopt(this.box);
    if (following) this.fit();
    else this.cameraPlace = cameraPlace;
  }

  /** Takes away what lies on one side of a plane; none: nothing. */
  setCut(cut: Cut | undefined): void {
    if (cut === this.cut) return;
    this.cut = cut;
    this.placeInScene();
    this.draw();
  }

  /** Drawn as a box; none: nothing. */
  setDomain(domain: WorldBox | undefined): void {
    this.domain = domain;
    this.placeInScene();
    this.draw();
  }

  /** As another viewer shows its mesh: from the same place, with the same look, cut alike. */
  mirror(other: Viewer): void {
    if (other.look !== this.look) this.setLook(other.look);
    this.setUp(other.up);
    this.setCut(other.cut);
    this.beside = other.box;
    this.setReach();
    this.mirrorCamera(other);
  }

  mirrorCamera(other: Viewer): void {
    if (!samePlace(this.cameraPlace, other.cameraPlace)) this.cameraPlace = other.cameraPlace;
  }

  /** Around the mesh that is shown; none if there is none. */
  get box(): WorldBox | undefined {
    return this.shown && worldBox(this.shown);
  }

  get upAxis(): UpAxis {
    return this.up;
  }

  /** The camera of the scene, whose coordinates inScene() gives. */
  get camera(): PerspectiveCamera {
    return this.controls.camera;
  }

  /** From the camera to what it turns about, world units. */
  get viewDistance(): number {
    return this.camera.position.distanceTo(this.controls.target);
  }

  /** Where what the camera turns about is seen, CSS pixels of the canvas. */
  get middle(): readonly [number, number] {
    const { x, y } = this.controls.target.clone().project(this.camera);
    return [((x + 1) / 2) * this.canvas.clientWidth, ((1 - y) / 2) * this.canvas.clientHeight];
  }

  /** The point of the water that is seen there, CSS pixels of the canvas; none where there is no water, or its particles in place of it. */
  pick(x: number, y: number): Pick | undefined {
    if (!this.shown || this.particles.shown) return undefined;
    const { clientWidth, clientHeight } = this.canvas;
    const far = new Vector3((2 * x) / clientWidth - 1, 1 - (2 * y) / clientHeight, 0.5).unproject(this.camera);
    const direction = far.sub(this.camera.position).normalize();
    return pick(
      this.shown,
      { origin: this.inWorld(this.camera.position), direction: toWorld(direction, [0, 0, 0], this.up) },
      this.cut,
    );
  }

  /** Looks at all of the mesh, also as it spreads, until a person moves the camera. */
  fit(): void {
    this.lookFrom(undefined);
  }

  /** The same, along an axis: from its positive end; from there, from its negative one. */
  lookAlong(axis: Axis): void {
    const direction = toScene(alongAxis(axis), [0, 0, 0], this.up);
    if (this.following && this.direction && this.direction.dot(direction) > 0.99) direction.negate();
    // A view straight up or down has no right and left.
    if (direction.y !== 0) direction.z += 1e-3;
    this.lookFrom(direction.normalize());
  }

  private lookFrom(direction: Vector3 | undefined): void {
    this.direction = direction;
    const box = unionOf([this.box, this.beside]);
    if (!box) return;
    this.following = box;
    this.adopt(box);
    this.lookAgain();
  }

  /** At once. */
  private lookAgain(): void {
    const place = this.placeToSee();
    if (!place) return;
    this.goal = place;
    this.controls.place(this.inScene(place.position), this.inScene(place.target));
    this.draw();
  }

  /** From where what matters of the mesh is seen, beside what covers the picture; none where there is no mesh. */
  private placeToSee(): CameraPlace | undefined {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const points = this.shown ? occupied(this.shown).map((point) => this.inScene(point)) : [];
    const beside = this.beside ? corners(this.beside).map((corner) => this.inScene(corner)) : [];
    if (points.length + beside.length === 0 || width === 0 || height === 0) return undefined;
    const { top, right, bottom } = this.margins;
    const free = {
      width: Math.max(0.2, 1 - right / width),
      height: Math.max(0.2, 1 - (top + bottom) / height),
    };
    const direction =
      this.direction ?? (free.width * width < 0.8 * free.height * height ? fitDirectionTall : fitDirection);
    const { target, distance } = framing(points.length > 0 ? points : beside, beside, direction, this.camera, free);
    return {
      position: this.inWorld(target.clone().addScaledVector(direction, distance)),
      target: this.inWorld(target),
    };
  }

  /** A step of the camera that follows, if it is not there yet. now: ms. */
  private step(now: number): void {
    const { goal, cameraPlace } = this;
    const since = now - this.drawnAt;
    this.drawnAt = now;
    if (!goal || samePlace(goal, cameraPlace)) return;
    // Where pictures take long the camera jumps: none is drawn for its way alone.
    const part = calm.matches ? 1 : 1 - Math.exp(-(since < pictureRests ? since : 16) / easing);
    const near = (1 - part) * apart(goal, cameraPlace) <= arrived * lengthOf(goal);
    const between = (from: Point, to: Point): Vector3 => this.inScene(from).lerp(this.inScene(to), near ? 1 : part);
    this.controls.place(between(cameraPlace.position, goal.position), between(cameraPlace.target, goal.target));
    if (!near) this.draw();
  }

  get cameraPlace(): CameraPlace {
    return { position: this.inWorld(this.controls.camera.position), target: this.inWorld(this.controls.target) };
  }

  set cameraPlace({ position, target }: CameraPlace) {
    this.stay();
    this.controls.place(this.inScene(position), this.inScene(target));
    this.draw();
  }

  /** Origin, reach and floor from this mesh: they stay, so that nothing jumps while the water moves. */
  private adopt(box: WorldBox | undefined): void {
    if (!this.shown || !box) return;
    const { position, target } = this.cameraPlace;
    this.origin = center(box);
    this.bricks.show(this.shown, this.origin);
    this.particles.moveTo(this.origin);
    this.showSpray();
    this.placeInScene();
    this.controls.place(this.inScene(position), this.inScene(target));
    this.environment.sceneSize.value = size(box);
    this.setReach();
    // Under the lowest corner, whichever axis is up.
    this.environment.floorCenter.value.set(0, this.inScene(box.min).y, 0);
    // The floor's lines lie at round lengths, and stay while the water moves.
    const step = roundLength(gridPart * (size(box) || 1));
    const { x, z } = this.inScene([0, 0, 0]);
    this.environment.gridStep.value = step;
    this.environment.gridOrigin.value.set(x % step, 0, z % step);
  }

  private setReach(): void {
    const box = unionOf([this.box, this.beside]);
    if (box) this.controls.setReach(size(box));
  }

  /** Sets the parts that depend on the scene's origin and the up axis. */
  private placeInScene(): void {
    this.cutPlanes.splice(0, 1, ...(this.cut ? [cutPlane(this.cut, this.origin, this.up)] : []));
    this.domainBox.show(this.domain, this.origin);
    this.waterChanged = true;
  }

  inScene(point: Point): Vector3 {
    return toScene(point, this.origin, this.up);
  }

  private inWorld(place: Vector3): Point {
    return toWorld(place, this.origin, this.up);
  }

  /** When the canvas has another size, or something else covers it. */
  resize(): void {
    const { clientWidth, clientHeight } = this.canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.renderer.getDrawingBufferSize(this.water.uniforms.screenSize.value);
    this.particles.setScreenHeight(this.canvas.height);
    this.spray.setScreenHeight(this.canvas.height);
    this.thickness.setSize(this.canvas.width / thicknessCoarseness, this.canvas.height / thicknessCoarseness);
    putInTheMiddle(this.controls.camera, this.margins, clientWidth, clientHeight);
    if (this.following) this.lookAgain();
    // At once: the canvas is blank now.
    this.render();
  }

  /** With the next picture of the browser. */
  draw(): void {
    if (this.scheduled) return;
    this.scheduled = true;
    requestAnimationFrame(() => {
      this.scheduled = false;
      this.render();
    });
  }

  /** At once. */
  render(): void {
    const { camera } = this.controls;
    const cut = this.cutPlanes.length > 0;
    this.step(performance.now());
    this.renderer.localClippingEnabled = cut;
    camera.updateMatrixWorld();
    this.background.update(camera);
    if (this.waterChanged) this.sunlight.render(this.renderer, this.scene);
    this.waterChanged = false;
    const surface = this.particles.shown === undefined;
    if (this.look === 'water' && surface && !this.coloring) this.thickness.render(this.renderer, this.scene, camera);
    this.renderer.info.reset();
    this.renderer.clear();
    if (!surface) camera.layers.disable(waterLayer);
    this.renderer.render(this.scene, camera);
    camera.layers.enable(waterLayer);
    const { triangles } = this.renderer.info.render;
    if (cut && surface) this.cutFace.render(this.renderer, this.scene, camera, this.environment.sceneSize.value);
    this.events.rendered();
    if (this.shown) this.events.drawn(this.shown.frame, triangles - 1, this.particles.shown);
  }
}

/** Up to what the way through the scene's coordinates costs. */
function samePlace(a: CameraPlace, b: CameraPlace): boolean {
  return apart(a, b) <= 1e-6 * lengthOf(a);
}

/** The way of position and target together. */
function apart(a: CameraPlace, b: CameraPlace): number {
  return distanceOf(a.position, b.position) + distanceOf(a.target, b.target);
}

function lengthOf({ position, target }: CameraPlace): number {
  return distanceOf(position, target);
}

function distanceOf(p: Point, q: Point): number {
  return Math.hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}
