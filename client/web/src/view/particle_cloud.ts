// Particles as round sprites of their radius.
import { BufferAttribute, BufferGeometry, Points } from 'three';
import type { Particles } from '../particles/particles';
import type { Point } from './bounds';
import { spriteMaterial } from './sprites';
import { pictureLayer } from './thickness_pass';

export class ParticleCloud {
  readonly material = spriteMaterial();
  readonly points = new Points(new BufferGeometry(), this.material);
  private current: Particles | undefined;

  constructor() {
    this.points.visible = false;
    this.points.frustumCulled = false;
    this.points.layers.set(pictureLayer);
  }

  get shown(): Particles | undefined {
    return this.current;
  }

  /** origin: of the scene, world units. */
  show(particles: Particles | undefined, origin: Point): void {
    if (particles !== this.current) {
      this.current = particles;
      this.points.geometry.dispose();
      this.points.geometry = particles ? geometry(particles) : new BufferGeometry();
    }
    this.points.visible = particles !== undefined;
    if (!particles) return;
    const { min, max, radius } = particles;
    this.points.position.set(min[0] - origin[0], min[1] - origin[1], min[2] - origin[2]);
    this.points.scale.set(max[0] - min[0], max[1] - min[1], max[2] - min[2]);
    this.material.uniforms.radius.value = radius;
  }

  moveTo(origin: Point): void {
    this.show(this.current, origin);
  }

  /** Sets the height of the picture, in its own pixels. */
  setScreenHeight(pixels: number): void {
    this.material.uniforms.screenHeight.value = pixels;
  }
}

function geometry({ positions, levels }: Particles): BufferGeometry {
  const made = new BufferGeometry();
  // As fractions of the box, which the object's scale stretches.
  made.setAttribute('position', new BufferAttribute(positions, 3, true));
  made.setAttribute('level', new BufferAttribute(levels ?? new Uint8Array(positions.length / 3), 1));
  return made;
}
