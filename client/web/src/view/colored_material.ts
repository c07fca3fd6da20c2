// The surface in the colors of what its vertices have: opaque; lit, so that its shape is seen, or exactly in the colors of the legend.
import { DataTexture, LinearFilter, ShaderMaterial, Vector2 } from 'three';
import { colorOf, type ColorMap } from '../color/color_maps';
import type { QuantityKind } from '../color/quantity';
import type { ValueRange } from '../color/value_range';
import { environmentGlsl, type EnvironmentUniforms } from './environment';
import { surfaceFragmentGlsl, surfaceVertexShader } from './surface_shader';

const mapColors = 256;

/** The shaders' differences: the origin of a fragment's color. An id has no mean: its triangles are of the color of one corner. */
const shading: Record<QuantityKind, { readonly value: string; readonly declare: string; readonly color: string }> = {
  number: {
    value: 'attribute float value;',
    declare: 'varying float shown;',
    color: 'texture2D(colorMap, vec2(clamp(shown * range.x + range.y, 0.0, 1.0) * 0.99609375 + 0.001953125, 0.5)).rgb',
  },
  color: { value: 'attribute vec3 value;', declare: 'varying vec3 shown;', color: 'shown' },
  id: { value: 'attribute vec3 value;', declare: 'flat varying vec3 shown;', color: 'shown' },
};

export class ColoredMaterial {
  readonly material: ShaderMaterial;
  private readonly table = new DataTexture(new Uint8Array(4 * mapColors), mapColors, 1);
  /** Factor and summand from a value to its part of the range. */
  private readonly range = new Vector2();
  private readonly unlit = { value: false };
  private map: ColorMap | undefined;

  constructor(kind: QuantityKind, environment: EnvironmentUniforms) {
    this.table.minFilter = this.table.magFilter = LinearFilter;
    const { value, declare, color } = shading[kind];
    this.material = new ShaderMaterial({
      uniforms: {
        ...environment,
        colorMap: { value: this.table },
        range: { value: this.range },
        unlit: this.unlit,
      },
      clipping: true,
      // Behind the wires that lie in it.
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
      vertexShader: surfaceVertexShader(`${value}\n${declare}`, 'shown = value;'),
      fragmentShader: /* glsl */ `
        ${environmentGlsl}
        ${surfaceFragmentGlsl}
        uniform sampler2D colorMap;
        uniform vec2 range;
        uniform bool unlit;
        ${declare}
        void main() {
          #include <clipping_planes_fragment>
          if (unlit) {
            gl_FragColor = vec4(${color}, 1.0);
            return;
          }
          vec3 v = toEye();
          vec3 n = facingNormal(v);
          float facing = clamp(dot(n, v), 0.0, 1.0);
          float lit = 0.5 + 0.5 * dot(n, sunDirection);
          float light = 0.55 + 0.3 * lit + 0.2 * facing;
          float highlight = 0.22 * pow(max(dot(n, normalize(v + sunDirection)), 0.0), 48.0);
          gl_FragColor = vec4(${color} * light + highlight, 1.0);
        }`,
    });
  }

  set(map: ColorMap, range: ValueRange | undefined, unlit: boolean): void {
    this.unlit.value = unlit;
    const extent = range ? range.high - range.low : 0;
    if (range && extent > 0) this.range.set(1 / extent, -range.low / extent);
    else this.range.set(0, 0.5);
    if (map === this.map) return;
    this.map = map;
    const data = this.table.image.data as Uint8Array;
    for (let i = 0; i < mapColors; ++i) data.set([...colorOf(map, i / (mapColors - 1)), 255], 4 * i);
    this.table.needsUpdate = true;
  }
}
