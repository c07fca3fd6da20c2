// Round sprites of a size in the world: a material for points.
import { ShaderMaterial } from 'three';

export type SpriteMaterial = ShaderMaterial & {
  readonly uniforms: { readonly radius: { value: number }; readonly screenHeight: { value: number } };
};

/** radius: world units; a point may have an attribute `level`, by which its radius doubles. screenHeight: of the picture, in its own pixels. */
export function spriteMaterial(): SpriteMaterial {
  return new ShaderMaterial({
    uniforms: { radius: { value: 0 }, screenHeight: { value: 1 } },
    clipping: true,
    vertexShader: /* glsl */ `
      #include <clipping_planes_pars_vertex>
      uniform float radius;
      uniform float screenHeight;
      attribute float level;
      void main() {
        vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
        gl_Position = projectionMatrix * mvPosition;
        gl_PointSize = max(2.0, radius * exp2(level) * projectionMatrix[1][1] * screenHeight / gl_Position.w);
        #include <clipping_planes_vertex>
      }`,
    fragmentShader: /* glsl */ `
      #include <clipping_planes_pars_fragment>
      void main() {
        #include <clipping_planes_fragment>
        vec2 across = 2.0 * gl_PointCoord - 1.0;
        float r2 = dot(across, across);
        if (r2 > 1.0) discard;
        // Lit from above left; the rim is dark, so that each stands out before its neighbors and before either background.
        float light = 0.55 * sqrt(1.0 - r2) + 0.45 * max(0.0, dot(vec3(across.x, -across.y, sqrt(1.0 - r2)), vec3(-0.48, 0.64, 0.6)));
        gl_FragColor = vec4(mix(vec3(0.02, 0.15, 0.32), vec3(0.42, 0.76, 0.98), light), 1.0);
      }`,
  }) as SpriteMaterial;
}
