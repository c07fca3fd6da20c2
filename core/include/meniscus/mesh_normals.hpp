// Normals that are computed from a mesh alone.
#pragma once

#include "meniscus/mesh.hpp"

namespace meniscus {

/// Gives the mesh normals that its triangles show, in place of those that it has: what a receiver computes where none
/// are sent. A vertex's normal is the sum over its triangles, crack filling excepted, each weighted by 1 / (|e|^2
/// |g|^2) of its two sides at the vertex (Max 1999: Weights for computing vertex normals from facet normals: exact on
/// spheres). A vertex of crack filling alone takes that; one where no triangle has an area gets (0, 0, 1).
///
/// The order of the triangles does not matter: the same mesh has the same normals to the bit through every codec. On a
/// mesh that ends, such as that of a region, border vertices know the triangles on their side alone.
///
/// mesh: welded, no triangle wider than a brick. Takes at most 48 bytes a vertex for as long as it works.
void compute_normals(Mesh& mesh);

}  // namespace meniscus
