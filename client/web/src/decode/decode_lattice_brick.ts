// One brick of the lattice codec, of either profile. Its decoder checks all that the bytes say.
import type { EncodedBrick } from '../bricks/frame';
import { maxBrickTriangles } from '../bricks/lattice';
import { storedAs, valuesOf } from './attribute_values';
import type { DecodedBrick } from './decoded_brick';
import type { LatticeModule } from './lattice_module';

/** name: of the attribute that is decoded, too, where the brick carries it. Throws an Error. */
export function decodeLatticeBrick(
  lattice: LatticeModule,
  { data, vertexCount, triangleCount, attributes }: EncodedBrick,
  offsetBits: number,
  name?: string,
): DecodedBrick {
  if (vertexCount > maxBrickTriangles || triangleCount > maxBrickTriangles)
    throw new Error(
      `${triangleCount} triangles and ${vertexCount} vertices are announced; a brick has at most ${maxBrickTriangles} of each`,
    );
  const stored = attributes.map(storedAs);
  const attributeBytes = stored.map(({ components, bytes }) => components * bytes);
  lattice.decode(data, { vertices: vertexCount, triangles: triangleCount, offsetBits, attributeBytes });
  const place = attributes.findIndex((attribute) => attribute.name === name);
  const form = attributes[place];
  return {
    positions: lattice.positions(vertexCount),
    normals: lattice.normals(vertexCount),
    ...(form && {
      attribute: {
        name: form.name,
        components: form.components,
        values: valuesOf(stored[place]!.of(lattice.attribute(place, vertexCount * attributeBytes[place]!)), form),
      },
    }),
    bounds: lattice.bounds(),
    indices: lattice.indices(vertexCount, triangleCount),
    levelTriangles: lattice.levelTriangles(),
  };
}
