// Particles as round sprites of their radius.
import { BufferAttribute, BufferGeometry, Points, ShaderMaterial } from 'three';
import type { Particles } from '../particles/particles';
import type { Point } from './bounds';
import { pictureLayer } from './thickness_pass';

export class ParticleCloud {
  private readonly material = new ShaderMaterial({
    uniforms: { radius: { value: 0 }, screenHeight: { value: 1 } },
    vertexShader: /* glsl */ `
      uniform float radius;
      uniform float screenHeight;
      attribute float level;
      void main() {
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
        gl_PointSize = max(2.0, radius * exp2(level) * projectionMatrix[1][1] * screenHeight / gl_Position.w);
      }`,
    fragmentShader: /* glsl */ `
      void main() {
        vec2 across = 2.0 * gl_PointCoord - 1.0;
        float r2 = dot(across, across);
        if (r2 > 1.0) discard;
        // Lit from above left; the rim is dark, so that each stands out before its neighbors and before either background.
        float light = 0.55 * sqrt(1.0 - r2) + 0.45 * max(0.0, dot(vec3(across.x, -across.y, sqrt(1.0 - r2)), vec3(-0.48, 0.64, 0.6)));
        gl_FragColor = vec4(mix(vec3(0.02, 0.15, 0.32), vec3(0.42, 0.76, 0.98), light), 1.0);
      }`,
  });
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
    this.material.uniforms.radius!.value = radius;
  }

  moveTo(origin: Point): void {
    this.show(this.current, origin);
  }

  /** Of the picture, in its own pixels. */
  setScreenHeight(pixels: number): void {
    this.material.uniforms.screenHeight!.value = pixels;
  }
}

function geometry({ positions, levels }: Particles): BufferGeometry {
  const made = new BufferGeometry();
  // As fractions of the box, which the object's scale stretches.
  made.setAttribute('position', new BufferAttribute(positions, 3, true));
  made.setAttribute('level', new BufferAttribute(levels ?? new Uint8Array(positions.length / 3), 1));
  return made;
}
