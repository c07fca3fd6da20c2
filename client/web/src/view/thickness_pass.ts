// How much water lies behind each pixel. The mesh is closed, so the distances of its back faces less those of its front faces add up to the
// exact way of the ray through it: one pass of additive blending.
import {
  AddEquation,
  CustomBlending,
  DoubleSide,
  HalfFloatType,
  LinearFilter,
  OneFactor,
  RedFormat,
  ShaderMaterial,
  WebGLRenderTarget,
  type Camera,
  type Scene,
  type Texture,
  type WebGLRenderer,
} from 'three';
import type { EnvironmentUniforms } from './environment';

/** Of the water's surface: that of every object unless it is told otherwise. */
export const waterLayer = 0;
/** Of what is in the picture without being water. */
export const pictureLayer = 1;

export class ThicknessPass {
  private readonly target: WebGLRenderTarget;
  private readonly material: ShaderMaterial;

  constructor(environment: EnvironmentUniforms) {
    this.target = new WebGLRenderTarget(1, 1, {
      format: RedFormat,
      type: HalfFloatType,
      minFilter: LinearFilter,
      magFilter: LinearFilter,
      depthBuffer: false,
    });
    this.material = new ShaderMaterial({
      uniforms: { sceneSize: environment.sceneSize },
      side: DoubleSide,
      depthTest: false,
      depthWrite: false,
      blending: CustomBlending,
      blendEquation: AddEquation,
      blendSrc: OneFactor,
      blendDst: OneFactor,
      vertexShader: /* glsl */ `
        varying vec3 fromCamera;
        void main() {
          vec4 view = modelViewMatrix * vec4(position, 1.0);
          fromCamera = view.xyz;
          gl_Position = projectionMatrix * view;
        }`,
      fragmentShader: /* glsl */ `
        uniform float sceneSize;
        varying vec3 fromCamera;
        void main() {
          float distance = (isOrthographic ? -fromCamera.z : length(fromCamera)) / sceneSize;
          // What all distances have in common cancels, and would only cost digits; not where the camera may be in the water.
          distance -= max(length(viewMatrix[3].xyz) / sceneSize - 0.5, 0.0);
          gl_FragColor = vec4(gl_FrontFacing ? -distance : distance, 0.0, 0.0, 1.0);
        }`,
    });
  }

  /** In scene sizes. */
  get texture(): Texture {
    return this.target.texture;
  }

  setSize(width: number, height: number): void {
    this.target.setSize(Math.max(1, Math.ceil(width)), Math.max(1, Math.ceil(height)));
  }

  render(renderer: WebGLRenderer, scene: Scene, camera: Camera): void {
    const { mask } = camera.layers;
    camera.layers.disable(pictureLayer);
    scene.overrideMaterial = this.material;
    renderer.setRenderTarget(this.target);
    renderer.setClearColor(0x000000, 0);
    renderer.clear();
    renderer.render(scene, camera);
    renderer.setRenderTarget(null);
    scene.overrideMaterial = null;
    camera.layers.mask = mask;
  }
}
