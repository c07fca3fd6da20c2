// A brick's triangles over vertices of its own.
#pragma once

#include <cstdint>
#include <vector>

#include "meniscus/memory.hpp"
#include "meniscus/mesh.hpp"

namespace meniscus {

/// Vertices are numbered in the order in which the triangles meet them.
struct BrickIndex {
    std::vector<std::uint32_t> vertices;  ///< indices into the mesh
    std::vector<Triangle> triangles;      ///< corners as indices into `vertices`
};

/// slots: of a hash table from a mesh's vertex to the brick's; grows as needed, and what it holds does not matter.
/// It takes 12 to 24 bytes for each triangle of the brick, however large the mesh is.
BrickIndex index_brick(const Mesh& mesh, const MeshBrick& brick, Array<std::uint32_t>& slots);

}  // namespace meniscus
