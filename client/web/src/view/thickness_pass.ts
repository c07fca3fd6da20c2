// How much water lies behind each pixel. The mesh is closed, so the distances of its back faces less those of its front faces add up to the
// exact way of the ray through it: one pass of additive blending. Of water that is cut the face of the cut is not drawn; it is as if it were, where
// every distance is less that of the plane.
import {
  AddEquation,
  CustomBlending,
  DoubleSide,
  HalfFloatType,
  LinearFilter,
  LinearMipmapNearestFilter,
  OneFactor,
  RedFormat,
  ShaderMaterial,
  WebGLRenderTarget,
  type Camera,
  type Plane,
  type Scene,
  type Texture,
  type WebGLRenderer,
} from 'three';
import type { EnvironmentUniforms } from './environment';

/** The layer of the water's surface, and of every object that is put in no other. */
export const waterLayer = 0;
/** The layer of objects in the picture that are not water. */
export const pictureLayer = 1;

export class ThicknessPass {
  private readonly target: WebGLRenderTarget;
  private readonly material: ShaderMaterial;

  /** clippingPlanes: none, or that of the cut. blurred: whether the texture has coarser levels, too. */
  constructor(environment: EnvironmentUniforms, clippingPlanes: Plane[], blurred = false) {
    this.target = new WebGLRenderTarget(1, 1, {
      format: RedFormat,
      type: HalfFloatType,
      minFilter: blurred ? LinearMipmapNearestFilter : LinearFilter,
      generateMipmaps: blurred,
      magFilter: LinearFilter,
      depthBuffer: false,
    });
    this.material = new ShaderMaterial({
      uniforms: { sceneSize: environment.sceneSize },
      clipping: true,
      clippingPlanes,
      side: DoubleSide,
      depthTest: false,
      depthWrite: false,
      blending: CustomBlending,
      blendEquation: AddEquation,
      blendSrc: OneFactor,
      blendDst: OneFactor,
      vertexShader: /* glsl */ `
        #include <clipping_planes_pars_vertex>
        varying vec3 fromCamera;
        void main() {
          vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
          fromCamera = mvPosition.xyz;
          gl_Position = projectionMatrix * mvPosition;
          #include <clipping_planes_vertex>
        }`,
      fragmentShader: /* glsl */ `
        #include <clipping_planes_pars_fragment>
        uniform float sceneSize;
        varying vec3 fromCamera;
        void main() {
          #include <clipping_planes_fragment>
          float distance = (isOrthographic ? -fromCamera.z : length(fromCamera)) / sceneSize;
          // What all distances have in common cancels, and would only cost digits; not where the camera may be in the water.
          float nearest = max(length(viewMatrix[3].xyz) / sceneSize - 0.5, 0.0);
          #if NUM_CLIPPING_PLANES > 0
            // Where the plane is crossed outside of the water, what is taken off cancels again, and too much of it would only cost digits.
            vec4 cut = clippingPlanes[0];
            float crossing = isOrthographic ? (dot(cut.xy, fromCamera.xy) + cut.w) / cut.z : -cut.w / dot(cut.xyz, normalize(fromCamera));
            crossing /= sceneSize;
            if (crossing > nearest && crossing < nearest + 2.0) nearest = crossing;
          #endif
          distance -= nearest;
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
