// Where the plane of the cut goes through the water: a hatched face. The mesh is closed, so the plane is inside where, of what is kept on a
// pixel's ray, the back faces are not as many as the front faces: the stencil counts them.
import {
  AlwaysStencilFunc,
  BackSide,
  Color,
  DecrementWrapStencilOp,
  DoubleSide,
  FrontSide,
  IncrementWrapStencilOp,
  Mesh,
  MeshBasicMaterial,
  NotEqualStencilFunc,
  PlaneGeometry,
  Scene,
  ShaderMaterial,
  type Camera,
  type Plane,
  type Side,
  type StencilOp,
  type WebGLRenderer,
} from 'three';
import type { Theme } from './environment';
import { pictureLayer } from './thickness_pass';

export class CutFace {
  private readonly counting: readonly MeshBasicMaterial[];
  private readonly material: ShaderMaterial & {
    uniforms: { faceColor: { value: Color }; hatchColor: { value: Color } };
  };
  private readonly face: Mesh;
  private readonly scene = new Scene();

  constructor(private readonly planes: Plane[]) {
    this.counting = [
      counter(BackSide, IncrementWrapStencilOp, planes),
      counter(FrontSide, DecrementWrapStencilOp, planes),
    ];
    const uniforms = { faceColor: { value: new Color() }, hatchColor: { value: new Color() } };
    this.material = new ShaderMaterial({
      uniforms,
      side: DoubleSide,
      stencilWrite: true,
      stencilFunc: NotEqualStencilFunc,
      stencilRef: 0,
      vertexShader: /* glsl */ `
        void main() {
          gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
        }`,
      fragmentShader: /* glsl */ `
        uniform vec3 faceColor;
        uniform vec3 hatchColor;
        void main() {
          float line = abs(fract((gl_FragCoord.x + gl_FragCoord.y) / 12.0) - 0.5);
          gl_FragColor = vec4(mix(hatchColor, faceColor, smoothstep(0.04, 0.12, line)), 1.0);
          #include <colorspace_fragment>
        }`,
    }) as typeof this.material;
    this.face = new Mesh(new PlaneGeometry(1, 1), this.material);
    this.face.frustumCulled = false;
    this.face.layers.set(pictureLayer);
    this.scene.add(this.face);
  }

  setTheme(theme: Theme): void {
    this.material.uniforms.faceColor.value.set(theme === 'light' ? 0x4f9fc4 : 0x2b6485);
    this.material.uniforms.hatchColor.value.set(theme === 'light' ? 0x2f7ca3 : 0x4a8fb5);
  }

  /** Over the picture of the scene, with its depth. sceneSize: world units. */
  render(renderer: WebGLRenderer, scene: Scene, camera: Camera, sceneSize: number): void {
    const [plane] = this.planes;
    if (!plane) return;
    const { mask } = camera.layers;
    camera.layers.disable(pictureLayer);
    for (const material of this.counting) {
      scene.overrideMaterial = material;
      renderer.render(scene, camera);
    }
    scene.overrideMaterial = null;
    camera.layers.mask = mask;
    plane.coplanarPoint(this.face.position);
    this.face.lookAt(this.face.position.clone().add(plane.normal));
    this.face.scale.setScalar(10 * sceneSize);
    renderer.render(this.scene, camera);
  }
}

/** Marks nothing but the stencil. */
function counter(side: Side, op: StencilOp, clippingPlanes: Plane[]): MeshBasicMaterial {
  return new MeshBasicMaterial({
    side,
    clippingPlanes,
    colorWrite: false,
    depthWrite: false,
    depthTest: false,
    stencilWrite: true,
    stencilFunc: AlwaysStencilFunc,
    stencilZPass: op,
  });
}
