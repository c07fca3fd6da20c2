// The particles that the surface leaves out, as drops beside it.
import { BufferAttribute, BufferGeometry, Points } from 'three';
import type { Frame } from '../bricks/frame';
import type { Point } from './bounds';
import { spriteMaterial } from './sprites';
import { pictureLayer } from './thickness_pass';

export class SprayCloud {
  readonly material = spriteMaterial();
  readonly points = new Points(new BufferGeometry(), this.material);
  private current: Float32Array | undefined;

  constructor() {
    this.points.frustumCulled = false;
    this.points.layers.set(pictureLayer);
  }

  /** origin: of the scene, world units. Drops are as wide as two finest cells. */
  show(frame: Pick<Frame, 'spray' | 'cellSize'> | undefined, origin: Point): void {
    if (frame?.spray !== this.current) {
      this.current = frame?.spray;
      this.points.geometry.dispose();
      this.points.geometry = new BufferGeometry();
      if (this.current) this.points.geometry.setAttribute('position', new BufferAttribute(this.current, 3));
    }
    this.points.visible = this.current !== undefined && this.current.length > 0;
    this.points.position.set(-origin[0], -origin[1], -origin[2]);
    this.material.uniforms.radius.value = frame?.cellSize ?? 0;
  }

  setScreenHeight(pixels: number): void {
    this.material.uniforms.screenHeight.value = pixels;
  }
}
