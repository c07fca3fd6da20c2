// How much water the sun's light has come through: what darkens the floor below the water and colors it.
import { Matrix4, OrthographicCamera, type Plane, type Scene, type WebGLRenderer } from 'three';
import type { EnvironmentUniforms } from './environment';
import { ThicknessPass } from './thickness_pass';

const pixels = 512;
/** Half the width of what is looked at, and its distance, in scene sizes: water that spreads after its first frame is still in it. */
const reach = 1.2;

export class Sunlight {
  private readonly pass: ThicknessPass;
  private readonly camera = new OrthographicCamera(-1, 1, 1, -1, 0, 2);
  private readonly toTexture = new Matrix4().makeScale(0.5, 0.5, 0.5).setPosition(0.5, 0.5, 0.5);

  constructor(
    private readonly environment: EnvironmentUniforms,
    clippingPlanes: Plane[],
  ) {
    this.pass = new ThicknessPass(environment, clippingPlanes, true);
    this.pass.setSize(pixels, pixels);
    environment.sunThickness.value = this.pass.texture;
  }

  /** When the water has changed. */
  render(renderer: WebGLRenderer, scene: Scene): void {
    const half = reach * this.environment.sceneSize.value;
    const { camera } = this;
    camera.left = camera.bottom = -half;
    camera.right = camera.top = half;
    camera.far = 2 * half;
    camera.position.copy(this.environment.sunDirection.value).multiplyScalar(half);
    camera.lookAt(0, 0, 0);
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    this.environment.sunMatrix.value
      .multiplyMatrices(this.toTexture, camera.projectionMatrix)
      .multiply(camera.matrixWorldInverse);
    this.pass.render(renderer, scene, camera);
  }
}
