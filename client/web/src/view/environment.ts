// Sky, sun and floor, generated: what water reflects and what is seen through it. No file is loaded.
import { Color, Matrix4, Vector3, type Texture } from 'three';
import { roundLength } from './scale_bar';

export type Theme = 'light' | 'dark';

/** Of the scene's size, at most: the way from one line of the floor to the next. */
const gridPart = 0.15;

/** Needs the uniforms of environmentUniforms(). The scene is y-up. */
export const environmentGlsl = /* glsl */ `
uniform vec3 zenithColor;
uniform vec3 horizonColor;
uniform vec3 floorColor;
uniform vec3 lineColor;
uniform vec3 sunColor;
uniform vec3 sunDirection;
uniform vec3 floorCenter;
uniform vec3 gridOrigin;
uniform float gridStep;
uniform float sceneSize;
uniform mat4 sunMatrix;
uniform sampler2D sunThickness;

const vec3 absorption = vec3(13.0, 4.2, 1.8);

// What is left of the sun's light where it has come through water. close: whether it is darker where water stands close by, too.
vec3 sunlightAt(vec3 place, bool close) {
  vec2 at = (sunMatrix * vec4(place, 1.0)).xy;
  if (any(lessThan(at, vec2(0.0))) || any(greaterThan(at, vec2(1.0)))) return vec3(1.0);
  float depth = max(textureLod(sunThickness, at, 0.0).r, 0.0);
  // Some is reflected and scattered away, whatever its color.
  vec3 left = exp(-(absorption + 2.0) * depth) * (1.0 - 0.25 * smoothstep(0.0, 0.01, depth));
  if (!close) return left;
  return left * (1.0 - 0.4 * smoothstep(0.0, 0.05, textureLod(sunThickness, at, 4.0).r));
}

vec3 skyColor(vec3 direction) {
  float height = clamp(direction.y, 0.0, 1.0);
  vec3 color = mix(horizonColor, zenithColor, sqrt(height));
  float sun = max(dot(direction, sunDirection), 0.0);
  return color + sunColor * (0.08 * pow(sun, 6.0) + 0.35 * pow(sun, 64.0));
}

float gridLine(float x, float width) {
  float distance = abs(fract(x - 0.5) - 0.5);
  // As strong as it is wide: far lines fade.
  return (1.0 - smoothstep(0.004, 0.004 + width, distance)) * min(1.0, 0.03 / width);
}

// lines: whether with the grid. distance: that the ray has come, for lines that are as soft as they are far.
vec3 floorAt(vec3 place, float distance, bool lines) {
  vec2 tile = (place.xz - gridOrigin.xz) / gridStep;
  float soft = 0.01 + 0.0025 * distance / gridStep;
  float line = lines ? max(gridLine(tile.x, soft), gridLine(tile.y, soft)) : 0.0;
  return mix(floorColor, lineColor, line) * (0.4 + 0.6 * sunlightAt(place, lines));
}

vec3 environment(vec3 origin, vec3 direction, bool lines) {
  vec3 sky = skyColor(direction);
  if (direction.y > -1e-4) return sky;
  // From water that lies on the floor, or a little in it, at once.
  float distance = max((floorCenter.y - origin.y) / direction.y, 0.0);
  vec3 place = origin + distance * direction;
  float far = length(place.xz - floorCenter.xz) / sceneSize;
  return mix(floorAt(place, distance, lines), horizonColor, smoothstep(0.8, 5.0, far));
}

// To the screen: filmic tone curve (Narkowicz's fit of ACES), sRGB.
vec3 displayed(vec3 color) {
  vec3 mapped = clamp(color * (2.51 * color + 0.03) / (color * (2.43 * color + 0.59) + 0.14), 0.0, 1.0);
  return mix(12.92 * mapped, 1.055 * pow(mapped, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, mapped));
}
`;

export interface EnvironmentUniforms {
  [name: string]: { value: unknown };
  zenithColor: { value: Color };
  horizonColor: { value: Color };
  floorColor: { value: Color };
  lineColor: { value: Color };
  sunColor: { value: Color };
  sunDirection: { value: Vector3 };
  /** What scatters in water that is thin, and in deep water. */
  shallowColor: { value: Color };
  deepColor: { value: Color };
  /** What water mirrors of the sky where it is seen from the side. */
  rimColor: { value: Color };
  /** How much of what is behind it the thinnest water hides, 0 to 1. */
  leastCover: { value: number };
  floorCenter: { value: Vector3 };
  /** A crossing of the floor's lines, and the way from one line to the next. */
  gridOrigin: { value: Vector3 };
  gridStep: { value: number };
  sceneSize: { value: number };
  /** To the place in the texture of how much water the sun's light has come through, in scene sizes. */
  sunMatrix: { value: Matrix4 };
  sunThickness: { value: Texture | null };
}

/** One set, shared by all materials. */
export function environmentUniforms(): EnvironmentUniforms {
  return {
    zenithColor: { value: new Color() },
    horizonColor: { value: new Color() },
    floorColor: { value: new Color() },
    lineColor: { value: new Color() },
    sunColor: { value: new Color() },
    sunDirection: { value: new Vector3(-0.45, 0.72, 0.53).normalize() },
    shallowColor: { value: new Color() },
    deepColor: { value: new Color() },
    rimColor: { value: new Color() },
    leastCover: { value: 0 },
    floorCenter: { value: new Vector3() },
    gridOrigin: { value: new Vector3() },
    gridStep: { value: 0.1 },
    sceneSize: { value: 1 },
    sunMatrix: { value: new Matrix4() },
    sunThickness: { value: null },
  };
}

/** Such that water stands out from the floor: brighter than a dark one, darker than a light one. */
const colors = {
  light: {
    zenithColor: 0x5d9fd8,
    horizonColor: 0xe9eff4,
    floorColor: 0xdde0e3,
    lineColor: 0xb9c1c8,
    sunColor: 0xfff1d8,
    shallowColor: 0x1c78b4,
    deepColor: 0x0a4a8c,
    rimColor: 0x17609c,
  },
  dark: {
    zenithColor: 0x060a10,
    horizonColor: 0x16202b,
    floorColor: 0x1a222b,
    lineColor: 0x2b3743,
    sunColor: 0xd6e4ff,
    shallowColor: 0x2f86bd,
    deepColor: 0x114c82,
    rimColor: 0x9fd4f6,
  },
} as const;

export function setTheme(uniforms: EnvironmentUniforms, theme: Theme): void {
  for (const [name, color] of Object.entries(colors[theme])) (uniforms[name]!.value as Color).set(color);
  uniforms.sunColor.value.multiplyScalar(3);
  uniforms.leastCover.value = theme === 'light' ? 0.55 : 0.28;
}

/** Below a scene of this size, its diagonal, at this height. Its lines lie at round lengths. crossing: of two of them, whatever its height. */
export function layFloor(uniforms: EnvironmentUniforms, sceneSize: number, height: number, crossing: Vector3): void {
  const step = roundLength(gridPart * (sceneSize || 1));
  uniforms.sceneSize.value = sceneSize;
  uniforms.floorCenter.value.set(0, height, 0);
  uniforms.gridStep.value = step;
  uniforms.gridOrigin.value.set(crossing.x % step, 0, crossing.z % step);
}
