// The environment behind the water: one triangle that covers the screen, drawn after the water and where there is none.
import { BufferAttribute, BufferGeometry, Matrix4, Mesh, ShaderMaterial, type PerspectiveCamera } from 'three';
import { environmentGlsl, type EnvironmentUniforms } from './environment';

export class Background {
  readonly mesh: Mesh;
  private readonly inverse = new Matrix4();

  constructor(environment: EnvironmentUniforms) {
    const triangle = new BufferGeometry();
    triangle.setAttribute('position', new BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
    const material = new ShaderMaterial({
      uniforms: { ...environment, inverseView: { value: this.inverse } },
      depthWrite: false,
      vertexShader: /* glsl */ `
        uniform mat4 inverseView;
        varying vec3 ray;
        void main() {
          gl_Position = vec4(position.xy, 1.0, 1.0);
          vec4 far = inverseView * vec4(position.xy, 1.0, 1.0);
          ray = far.xyz / far.w - cameraPosition;
        }`,
      fragmentShader: /* glsl */ `
        ${environmentGlsl}
        varying vec3 ray;
        void main() {
          gl_FragColor = vec4(displayed(environment(cameraPosition, normalize(ray), true)), 1.0);
        }`,
    });
    this.mesh = new Mesh(triangle, material);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 1;
  }

  update(camera: PerspectiveCamera): void {
    this.inverse.multiplyMatrices(camera.matrixWorld, camera.projectionMatrixInverse);
  }
}
