// The picture: scene, camera and looks. Drawn when something has changed, not otherwise.
import { Scene, Vector3, WebGLRenderer, type PerspectiveCamera, type Plane } from 'three';
import type { Shown } from '../bricks/brick_store';
import type { Frame } from '../bricks/frame';
import type { ColorMap } from '../color/color_maps';
import type { Quantity, QuantityKind } from '../color/quantity';
import type { ValueRange } from '../color/value_range';
import type { Particles } from '../particles/particles';
import { Background } from './background';
import { center, corners, size, unionOf, worldBox, type Point, type WorldBox } from './bounds';
import { BrickMeshes } from './brick_meshes';
import { CameraControls } from './camera_controls';
import { samePlace, type CameraPlace } from './camera_place';
import { legendHeight } from './color_legend';
import { ColoredMaterial } from './colored_material';
import { cutPlane, type Cut } from './cut';
import { CutFace } from './cut_face';
import { DomainBox } from './domain_box';
import { environmentUniforms, layFloor, setTheme, type Theme } from './environment';
import { putInTheMiddle, type Margins } from './fit';
import { FollowingCamera, type Sight } from './following_camera';
import { levelLineMaterials, levelSurfaceMaterial, plainLineMaterials } from './level_materials';
import { occupied } from './occupied';
import { ParticleCloud } from './particle_cloud';
import { pick, type Pick } from './pick';
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
  private readonly followingCamera: FollowingCamera;
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
        this.followingCamera.stay();
        this.events.moving(moving);
      },
    });
    this.followingCamera = new FollowingCamera(this.controls, {
      inScene: (point) => this.inScene(point),
      inWorld: (place) => this.inWorld(place),
      adopt: (box) => {
        this.adopt(box);
      },
      sight: () => this.sight(),
      draw: () => {
        this.draw();
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
    this.followingCamera.follow(box);
    this.draw();
  }

  /** Sets another box to keep in view wherever all of the mesh is. */
  setBeside(box: WorldBox | undefined): void {
    this.beside = box;
    this.setReach();
    this.followingCamera.follow(box);
  }

  /** The floor alone, until there is something. */
  private lookAtNothing(): void {
    this.origin = [0, 0, 0];
    layFloor(this.environment, 1, 0, new Vector3());
    this.followingCamera.lookAtNothing();
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
    const { cameraPlace } = this;
    this.up = up;
    turnUp(this.bricks.group, up);
    this.adopt(this.box);
    if (this.followingCamera.follows) this.fit();
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
    this.followingCamera.fit(this.boxInView);
  }

  /** The same, along an axis: from its positive end; from there, from its negative one. */
  lookAlong(axis: Axis): void {
    this.followingCamera.lookAlong(toScene(alongAxis(axis), [0, 0, 0], this.up), this.boxInView);
  }

  /** Around all that is to be kept in view. */
  private get boxInView(): WorldBox | undefined {
    return unionOf([this.box, this.beside]);
  }

  /** The mesh but for its outliers, and the box beside it. */
  private sight(): Sight {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const points = this.shown ? occupied(this.shown).map((point) => this.inScene(point)) : [];
    const all = this.beside ? corners(this.beside).map((corner) => this.inScene(corner)) : [];
    return { points, all, width, height, covered: this.margins };
  }

  get cameraPlace(): CameraPlace {
    return this.followingCamera.place;
  }

  set cameraPlace(place: CameraPlace) {
    this.followingCamera.stay();
    this.followingCamera.moveTo(place);
    this.draw();
  }

  /** Origin, reach and floor from this mesh: they stay, so that nothing jumps while the water moves. */
  private adopt(box: WorldBox | undefined): void {
    if (!this.shown || !box) return;
    const { cameraPlace } = this;
    this.origin = center(box);
    this.bricks.show(this.shown, this.origin);
    this.particles.moveTo(this.origin);
    this.showSpray();
    this.placeInScene();
    this.followingCamera.moveTo(cameraPlace);
    this.setReach();
    // Under the lowest corner, whichever axis is up. Its lines stay while the water moves.
    layFloor(this.environment, size(box), this.inScene(box.min).y, this.inScene([0, 0, 0]));
  }

  private setReach(): void {
    const box = this.boxInView;
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
    this.followingCamera.lookAgain();
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
    this.followingCamera.step(performance.now());
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
