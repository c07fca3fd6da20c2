// The common shader code of the surface's materials: its place and its normal from the vertex stage, and the normal toward the eye in the fragment's.

const shared = /* glsl */ `
varying vec3 place;
varying vec3 outward;
`;

/** declarations and statements: what a material adds to the stage. */
export function surfaceVertexShader(declarations = '', statements = ''): string {
  return /* glsl */ `
    #include <clipping_planes_pars_vertex>
    ${shared}
    ${declarations}
    void main() {
      vec4 world = modelMatrix * vec4(position, 1.0);
      place = world.xyz;
      // Bricks are scaled alike on all axes.
      outward = mat3(modelMatrix) * normal;
      ${statements}
      vec4 mvPosition = viewMatrix * world;
      gl_Position = projectionMatrix * mvPosition;
      #include <clipping_planes_vertex>
    }`;
}

/** Gives a fragment stage toEye() and facingNormal(). */
export const surfaceFragmentGlsl = /* glsl */ `
#include <clipping_planes_pars_fragment>
${shared}
vec3 toEye() {
  return normalize(cameraPosition - place);
}

/** One that looks away from the eye, as seen at a silhouette, is turned until it does not. */
vec3 facingNormal(vec3 v) {
  vec3 n = normalize(outward);
  return dot(n, v) < 0.0 ? normalize(n - 1.02 * dot(n, v) * v) : n;
}
`;
