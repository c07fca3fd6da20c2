// The mesh as the paper's Figure 7 shows it: wires colored by level over a dim surface.
import { LineBasicMaterial, ShaderMaterial } from 'three';

/** Level 1 blue, 2 green, 3 red, crack filling purple. */
export const levelColors = [0x3b82f6, 0x22a55b, 0xe5484d, 0xb05be6] as const;

export function levelLineMaterials(): LineBasicMaterial[] {
  return levelColors.map((color) => new LineBasicMaterial({ color, toneMapped: false }));
}

/** Over a surface whose colors mean something else: of one color, so that those are seen. */
export function plainLineMaterials(): LineBasicMaterial[] {
  const material = new LineBasicMaterial({ color: 0x101418, transparent: true, opacity: 0.35, toneMapped: false });
  return levelColors.map(() => material);
}

/** The surface that the wires lie on, and that hides wires behind it. */
export function levelSurfaceMaterial(): ShaderMaterial {
  return new ShaderMaterial({
    uniforms: { surfaceColor: { value: [0, 0, 0] } },
    clipping: true,
    // Behind the wires that lie in it.
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
    vertexShader: /* glsl */ `
      #include <clipping_planes_pars_vertex>
      varying vec3 view;
      void main() {
        vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
        view = mvPosition.xyz;
        gl_Position = projectionMatrix * mvPosition;
        #include <clipping_planes_vertex>
      }`,
    fragmentShader: /* glsl */ `
      #include <clipping_planes_pars_fragment>
      uniform vec3 surfaceColor;
      varying vec3 view;
      void main() {
        #include <clipping_planes_fragment>
        vec3 n = normalize(cross(dFdx(view), dFdy(view)));
        gl_FragColor = vec4(surfaceColor * (0.65 + 0.35 * abs(n.z)), 1.0);
      }`,
  });
}
