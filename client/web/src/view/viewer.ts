// The picture: scene, camera and looks. Drawn when something has changed, not otherwise.
import { Scene, Vector3, WebGLRenderer } from 'three';
import type { Shown } from '../bricks/brick_store';
import type { Frame } from '../bricks/frame';
import type { Particles } from '../particles/particles';
import { Background } from './background';
import { center, contains, corners, size, union, worldBox, type Point, type WorldBox } from './bounds';
import { BrickMeshes } from './brick_meshes';
import { CameraControls } from './camera_controls';
import { environmentUniforms, setTheme, type Theme } from './environment';
import { distanceToSee, putInTheMiddle, type Margins } from './fit';
import { levelLineMaterials, levelSurfaceMaterial } from './level_materials';
import { ParticleCloud } from './particle_cloud';
import { SprayCloud } from './spray_cloud';
import { Sunlight } from './sunlight';
import { pictureLayer, ThicknessPass, waterLayer } from './thickness_pass';
import { toScene, toWorld, turnUp, type UpAxis } from './up_axis';
import { waterMaterial } from './water_material';

export type Look = 'water' | 'levels';

export interface CameraPlace {
  readonly position: Point;
  readonly target: Point;
}

export interface ViewerEvents {
  /** A picture of the frame has been drawn, with so many triangles, or with particles. */
  drawn(frame: Frame, triangles: number, particles: Particles | undefined): void;
  moving(moving: boolean): void;
  /** The browser has taken the graphics hardware away, or given it back. */
  lost(lost: boolean): void;
}

/** Pixels of the screen per pixel of the water's thickness, on each axis. */
const thicknessCoarseness = 2;
/** From the mesh to a camera that looks at all of it. */
const fitDirection = new Vector3(0.55, 0.4, 1).normalize();

export class Viewer {
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly environment = environmentUniforms();
  private readonly water = waterMaterial(this.environment);
  private readonly levelSurface = levelSurfaceMaterial();
  private readonly background = new Background(this.environment);
  private readonly thickness = new ThicknessPass(this.environment);
  private readonly sunlight = new Sunlight(this.environment);
  private readonly bricks = new BrickMeshes(this.water, levelLineMaterials());
  private readonly particles = new ParticleCloud();
  private readonly spray = new SprayCloud();
  readonly controls: CameraControls;
  /** What the scene's coordinates are relative to, so that they stay small wherever the water is. */
  private origin: Point = [0, 0, 0];
  private shown: Shown | undefined;
  private look: Look = 'water';
  private up: UpAxis = 'y';
  private scheduled = false;
  /** Since the last picture. */
  private waterChanged = true;
  /** What the camera was placed to show, until a person moves it. */
  private following: WorldBox | undefined;

  /** Throws if there is no WebGL 2. */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    /** What covers the canvas now. */
    private readonly covered: () => Margins,
    private readonly events: ViewerEvents,
  ) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, powerPreference: 'high-performance' });
    this.renderer.autoClear = false;
    this.renderer.info.autoReset = false;
    this.water.uniforms.thickness.value = this.thickness.texture;
    this.scene.add(this.background.mesh, this.bricks.group);
    this.bricks.group.add(this.particles.points, this.spray.points);
    this.background.mesh.layers.set(pictureLayer);
    this.controls = new CameraControls(canvas, {
      changed: () => {
        this.draw();
      },
      moving: (moving) => {
        this.following = undefined;
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
    this.following = undefined;
    this.bricks.clear();
    this.showSpray();
    this.waterChanged = true;
    this.draw();
  }

  show(shown: Shown): void {
    const first = this.shown === undefined || this.shown.bricks.size === 0;
    this.shown = shown;
    this.water.uniforms.hasNormals.value = [...shown.bricks.values()].every(
      ({ decoded }) => decoded.normals !== undefined,
    );
    const box = worldBox(shown);
    if (first) this.adopt(box);
    else this.bricks.show(shown, this.origin);
    this.showSpray();
    this.waterChanged = true;
    if (box && this.following && !contains(this.following, box)) this.lookAt(union(this.following, box));
    this.draw();
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
    this.bricks.setLook(look === 'water' ? this.water : this.levelSurface, look === 'levels');
    this.draw();
  }

  setTheme(theme: Theme): void {
    setTheme(this.environment, theme);
    this.levelSurface.uniforms.surfaceColor!.value = theme === 'light' ? [0.93, 0.94, 0.95] : [0.1, 0.12, 0.14];
    this.draw();
  }

  setUp(up: UpAxis): void {
    if (up === this.up) return;
    this.up = up;
    turnUp(this.bricks.group, up);
    this.fit();
  }

  /** Looks at all of the mesh, also as it spreads, until a person moves the camera. */
  fit(): void {
    const box = this.shown && worldBox(this.shown);
    if (box) this.lookAt(box);
  }

  private lookAt(box: WorldBox): void {
    this.following = box;
    this.adopt(box);
    const target = this.inScene(center(box));
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const margins = this.covered();
    const free = {
      width: Math.max(0.2, 1 - margins.right / width),
      height: Math.max(0.2, 1 - (margins.top + margins.bottom) / height),
    };
    const seen = corners(box).map((corner) => this.inScene(corner).sub(target));
    const distance = distanceToSee(seen, fitDirection, this.controls.camera, free);
    this.controls.place(target.clone().addScaledVector(fitDirection, distance), target);
    this.draw();
  }

  get cameraPlace(): CameraPlace {
    return { position: this.inWorld(this.controls.camera.position), target: this.inWorld(this.controls.target) };
  }

  set cameraPlace({ position, target }: CameraPlace) {
    this.following = undefined;
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
    this.waterChanged = true;
    this.controls.place(this.inScene(position), this.inScene(target));
    this.environment.sceneSize.value = size(box);
    this.controls.setReach(size(box));
    // Under the lowest corner, whichever axis is up.
    this.environment.floorCenter.value.set(0, this.inScene(box.min).y, 0);
  }

  private inScene(point: Point): Vector3 {
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
    putInTheMiddle(this.controls.camera, this.covered(), clientWidth, clientHeight);
    if (this.following) this.lookAt(this.following);
    // At once: the canvas is blank now.
    this.render();
  }

  private draw(): void {
    if (this.scheduled) return;
    this.scheduled = true;
    requestAnimationFrame(() => {
      this.scheduled = false;
      this.render();
    });
  }

  private render(): void {
    const { camera } = this.controls;
    camera.updateMatrixWorld();
    this.background.update(camera);
    if (this.waterChanged) this.sunlight.render(this.renderer, this.scene);
    this.waterChanged = false;
    const surface = this.particles.shown === undefined;
    if (this.look === 'water' && surface) this.thickness.render(this.renderer, this.scene, camera);
    this.renderer.info.reset();
    this.renderer.clear();
    if (!surface) camera.layers.disable(waterLayer);
    this.renderer.render(this.scene, camera);
    camera.layers.enable(waterLayer);
    if (this.shown) this.events.drawn(this.shown.frame, this.renderer.info.render.triangles - 1, this.particles.shown);
  }
}
