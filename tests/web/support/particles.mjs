// Particles of known places, for `meniscus reconstruct`.
import { writeFileSync } from 'node:fs';

/** Writes points, x y z each, as a PLY. */
export function writeParticles(file, points) {
  const fields = ['x', 'y', 'z'].map((axis) => `property float ${axis}\n`).join('');
  const header = `ply\nformat ascii 1.0\nelement vertex ${points.length}\n${fields}end_header\n`;
  writeFileSync(file, `${header}${points.map((point) => point.join(' ')).join('\n')}\n`);
}

/** nx x ny x nz of them, so far apart on all axes. */
export function lattice(nx, ny, nz, spacing) {
  const points = [];
  for (let x = 0; x < nx; ++x)
    for (let y = 0; y < ny; ++y) for (let z = 0; z < nz; ++z) points.push([x * spacing, y * spacing, z * spacing]);
  return points;
}
