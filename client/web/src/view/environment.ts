// Sky, sun and floor, generated: what water reflects and what is seen through it. No file is loaded.
import { Color, Vector3 } from 'three';

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

// distance: that the ray has come, for lines that are as soft as they are far.
vec3 floorAt(vec3 place, float distance) {
  vec2 tile = (place.xz - floorCenter.xz) / (0.125 * sceneSize);
  float soft = 0.02 + 0.02 * distance / sceneSize;
  float line = max(gridLine(tile.x, soft), gridLine(tile.y, soft));
  return mix(floorColor, lineColor, 0.6 * line);
}

vec3 environment(vec3 origin, vec3 direction) {
  vec3 sky = skyColor(direction);
  if (direction.y > -1e-4) return sky;
  float distance = (floorCenter.y - origin.y) / direction.y;
  if (distance <= 0.0) return horizonColor;
  vec3 place = origin + distance * direction;
  float far = length(place.xz - floorCenter.xz) / sceneSize;
  return mix(floorAt(place, distance), horizonColor, smoothstep(0.8, 5.0, far));
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
  };
}

export function setTheme(uniforms: EnvironmentUniforms, theme: Theme): void {
  const [zenith, horizon, floor, line, sun] =
    theme === 'light'
      ? ([0x3d7fc4, 0xe9f1f7, 0xc9ced2, 0x8a949c, 0xfff1d8] as const)
      : ([0x0a1626, 0x2b3a4a, 0x242b32, 0x4a5661, 0xbfd4ff] as const);
  uniforms.zenithColor.value.set(zenith);
  uniforms.horizonColor.value.set(horizon);
  uniforms.floorColor.value.set(floor);
  uniforms.lineColor.value.set(line);
  uniforms.sunColor.value.set(sun).multiplyScalar(3);
}
