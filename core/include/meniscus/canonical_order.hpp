// The order of a mesh's vertices and triangles that follows from its geometry alone.
#pragma once

#include "meniscus/mesh.hpp"

namespace meniscus {

/// The same surface, in the same order wherever it was made: vertices, with all that they have, by x, then y, then z;
/// of a triangle the first vertex of these first, the orientation kept; the triangles of a level by their first, second
/// and third vertex. Files are written in this order, and mesh_sha256() hashes in it. The triangles of a brick do not
/// lie together in it, so that the result has no `bricks`. Takes 4 bytes a vertex while it works, and as much as the
/// largest array of the vertices; up to 36 bytes a vertex where one far away leaves most in a single slice of x.
void put_in_canonical_order(Mesh& mesh);
/// A copy in that order.
Mesh in_canonical_order(const Mesh& mesh);

}  // namespace meniscus
