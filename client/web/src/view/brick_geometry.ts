// A decoded brick on the graphics hardware: as it is, positions in brick-local steps, 16 bytes per point.
import { BufferAttribute, BufferGeometry, Sphere, Vector3 } from 'three';
import type { PointValues } from '../color/quantity';
import type { DecodedBrick } from '../decode/decoded_brick';

/** values: of the points, to be colored by. */
export function surfaceGeometry(brick: DecodedBrick, values?: PointValues): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(brick.positions, 4));
  if (brick.normals) geometry.setAttribute('normal', new BufferAttribute(brick.normals, 4, true));
  if (values) geometry.setAttribute('value', valueAttribute(values));
  geometry.setIndex(new BufferAttribute(brick.indices, 1));
  geometry.boundingSphere = boundingSphere(brick);
  return geometry;
}

function valueAttribute({ values }: PointValues): BufferAttribute {
  return values instanceof Float32Array ? new BufferAttribute(values, 1) : new BufferAttribute(values, 4, true);
}

/** The edges of the triangles, one range for each level. */
export function wireGeometry(brick: DecodedBrick, surface: BufferGeometry): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', surface.getAttribute('position'));
  geometry.setIndex(new BufferAttribute(edges(brick.indices), 1));
  geometry.boundingSphere = surface.boundingSphere;
  let start = 0;
  brick.levelTriangles.forEach((triangles, level) => {
    if (triangles > 0) geometry.addGroup(start, 6 * triangles, level);
    start += 6 * triangles;
  });
  return geometry;
}

function edges(triangles: Uint16Array | Uint32Array): Uint16Array | Uint32Array {
  const lines =
    triangles instanceof Uint16Array ? new Uint16Array(2 * triangles.length) : new Uint32Array(2 * triangles.length);
  for (let from = 0, to = 0; from < triangles.length; from += 3, to += 6) {
    const a = triangles[from]!;
    const b = triangles[from + 1]!;
    const c = triangles[from + 2]!;
    lines.set([a, b, b, c, c, a], to);
  }
  return lines;
}

function boundingSphere({ bounds: { min, max } }: DecodedBrick): Sphere {
  const low = new Vector3(...min);
  const high = new Vector3(...max);
  return new Sphere(low.clone().add(high).multiplyScalar(0.5), low.distanceTo(high) / 2);
}
