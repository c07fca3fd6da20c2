// A whole mesh as one Draco mesh: what bricks are compared with.
#pragma once

#include <cstddef>

#include "meniscus/brick_coding.hpp"

namespace meniscus::benchmarks {

/// The bytes that Draco makes of the mesh's positions, connectivity and normals: the same integer coordinates as in
/// bricks, relative to the mesh's lowest corner, in uint16 where they fit, else in uint32. Levels are left out.
std::size_t encode_in_one_piece(const Mesh& mesh, const CodingOptions& options);

}  // namespace meniscus::benchmarks
