// Sky, sun and floor, generated: what water reflects and what is seen through it. No file is loaded.
import { Color, Matrix4, Vector3, type Texture } from 'three';

export type Theme = 'light' | 'dark';

/** Needs the uniforms of environmentUniforms(). The scene is y-up. */
export const environmentGlsl = /* glsl */ `
uniform vec3 zenithColor;
uniform vec3 horizonColor;
uniform vec3 floorColor;
uniform vec3 lineColor;
uniform vec3 sunColor;
uniform vec3 sunDirection;
uniform vec3 floorCenter;
uniform float sceneSize;
uniform mat4 sunMatrix;
uniform sampler2D sunThickness;

const vec3 absorption = vec3(13.0, 4.2, 1.8);

// What is left of the sun's light where it has come through water.
vec3 sunlightAt(vec3 place) {
  vec2 at = (sunMatrix * vec4(place, 1.0)).xy;
  if (any(lessThan(at, vec2(0.0))) || any(greaterThan(at, vec2(1.0)))) return vec3(1.0);
  float depth = max(texture2D(sunThickness, at).r, 0.0);
  // Some is reflected and scattered away, whatever its color.
  return exp(-(absorption + 2.0) * depth) * (1.0 - 0.25 * smoothstep(0.0, 0.01, depth));
}

vec3 skyColor(vec3 direction) {
  float height = clamp(direction.y, 0.0, 1.0);
  vec3 color = mix(horizonColor, zenithColor, sqrt(height));
  float sun = max(dot(direction, sunDirection), 0.0);
  return color + sunColor * (0.08 * pow(sun, 6.0) + 0.35 * pow(sun, 64.0));
}

float gridLine(float x, float width) {
  float distance = abs(fract(x - 0.5) - 0.5);
  return 1.0 - smoothstep(0.012, 0.012 + width, distance);
}

// lines: whether with the grid. distance: that the ray has come, for lines that are as soft as they are far.
vec3 floorAt(vec3 place, float distance, bool lines) {
  vec2 tile = (place.xz - floorCenter.xz) / (0.125 * sceneSize);
  float soft = 0.02 + 0.02 * distance / sceneSize;
  float line = lines ? max(gridLine(tile.x, soft), gridLine(tile.y, soft)) : 0.0;
  return mix(floorColor, lineColor, 0.6 * line) * (0.4 + 0.6 * sunlightAt(place));
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
  floorCenter: { value: Vector3 };
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
    floorCenter: { value: new Vector3() },
    sceneSize: { value: 1 },
    sunMatrix: { value: new Matrix4() },
    sunThickness: { value: null },
  };
}

export function setTheme(uniforms: EnvironmentUniforms, theme: Theme): void {
  const [zenith, horizon, floor, line, sun] =
    theme === 'light'
      ? ([0x2f74c0, 0xdfeaf3, 0xd3d6d8, 0x98a1a8, 0xfff1d8] as const)
      : ([0x0e2440, 0x33475c, 0x39434c, 0x5b6873, 0xd6e4ff] as const);
  uniforms.zenithColor.value.set(zenith);
  uniforms.horizonColor.value.set(horizon);
  uniforms.floorColor.value.set(floor);
  uniforms.lineColor.value.set(line);
  uniforms.sunColor.value.set(sun).multiplyScalar(3);
}
