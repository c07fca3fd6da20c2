// Water as a dielectric: Fresnel reflection and refraction of the environment, absorption along the ray's way through it, and the sun.
import { ShaderMaterial, Vector2, type Texture } from 'three';
import { environmentGlsl, type EnvironmentUniforms } from './environment';
import { surfaceFragmentGlsl, surfaceVertexShader } from './surface_shader';

export interface WaterUniforms {
  [name: string]: { value: unknown };
  thickness: { value: Texture | null };
  screenSize: { value: Vector2 };
}

export function waterMaterial(environment: EnvironmentUniforms): ShaderMaterial & { uniforms: WaterUniforms } {
  const water: WaterUniforms = {
    thickness: { value: null },
    screenSize: { value: new Vector2(1, 1) },
  };
  const material = new ShaderMaterial({
    uniforms: { ...environment, ...water },
    clipping: true,
    vertexShader: surfaceVertexShader(),
    fragmentShader: /* glsl */ `
      ${environmentGlsl}
      ${surfaceFragmentGlsl}
      uniform sampler2D thickness;
      uniform vec2 screenSize;
      uniform vec3 shallowColor;
      uniform vec3 deepColor;
      uniform vec3 rimColor;
      uniform float leastCover;

      const float indexRatio = 1.0 / 1.333;
      const float normalReflectance = 0.02;
      const float roughness = 0.15;

      // GGX, for the sun alone: the environment is smooth already.
      float sunHighlight(vec3 n, vec3 v) {
        vec3 h = normalize(v + sunDirection);
        float a2 = roughness * roughness * roughness * roughness;
        float nh = max(dot(n, h), 0.0);
        float d = nh * nh * (a2 - 1.0) + 1.0;
        return a2 / (3.14159 * d * d) * max(dot(n, sunDirection), 0.0);
      }

      void main() {
        #include <clipping_planes_fragment>
        vec3 v = toEye();
        vec3 n = facingNormal(v);
        float facing = clamp(dot(n, v), 0.0, 1.0);
        float aside = (1.0 - facing) * (1.0 - facing);
        float rim = aside * aside;
        float fresnel = normalReflectance + (1.0 - normalReflectance) * rim * (1.0 - facing);

        float depth = max(texture2D(thickness, gl_FragCoord.xy / screenSize).r, 0.0);
        vec3 absorbed = exp(-absorption * depth);
        // What comes back from within, more of it where the sun falls in. Thin water has some, too: a sheet is seen, and an edge does not dissolve.
        float lit = 0.5 + 0.5 * dot(n, sunDirection);
        float clear = exp(-7.0 * depth);
        vec3 body = mix(deepColor, shallowColor, clear) * (0.3 + 0.25 * n.y + 0.75 * lit * lit);
        float clear2 = clear * clear;
        float cover = mix(0.9, leastCover, clear2 * clear2 * clear);

        // Where the ray leaves the water it is bent again, on the whole halfway back. The water shows the floor without its lines: bent by every
        // ripple, they would look like cracks in the mesh.
        vec3 bent = refract(-v, n, indexRatio);
        vec3 through = mix(environment(place + bent * depth * sceneSize, normalize(bent - v), false) * absorbed, body, cover);
        // Rays that it sends downwards are few, and meet a floor that has the horizon's color soon.
        vec3 mirrored = skyColor(reflect(-v, n));
        vec3 color = mix(mix(through, mirrored, fresnel), rimColor, 0.7 * rim) + sunColor * fresnel * sunHighlight(n, v);
        gl_FragColor = vec4(displayed(color), 1.0);
      }`,
  });
  return material as unknown as ShaderMaterial & { uniforms: WaterUniforms };
}
