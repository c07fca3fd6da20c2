// How two meshes differ, to the bit and element by element: their order counts.
#pragma once

#include <cstddef>
#include <string>

#include "meniscus/mesh.hpp"

namespace meniscus::benchmarks {

struct MeshDifference {
    std::size_t count = 0;  ///< elements of all arrays; where one is longer, what it has more of counts, too
    std::string first;      ///< array, index, and both elements; empty without any

    bool any() const { return count != 0; }
};

/// Vertices, normals, triangles, levels, bricks and spray.
MeshDifference find_difference(const Mesh& cpu, const Mesh& gpu);

}  // namespace meniscus::benchmarks
