// The lattice behind a mesh, of which its vertices and triangles follow: what the lattice codec codes.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "meniscus/memory.hpp"

namespace meniscus {

/// A block of 4 x 4 x 4 lattice points (core/README.md#words) that a brick's triangles depend on.
struct LatticeBlock {
    std::uint64_t inside;                ///< signs of its points: x + 4 y + 16 z; what no cell asks for is arbitrary
    std::array<std::uint64_t, 3> edges;  ///< by axis: its finest edges that carry a vertex of the mesh
    std::uint32_t first_vertex;          ///< number of its first vertex in the mesh, by axis, then by bit
    std::uint16_t place;                 ///< x + 17 y + 289 z in the closed brick, whose upper faces are the next's
    std::uint8_t level;                  ///< of its base cell, if that belongs to the brick and draws; else 0
    std::uint8_t coarser;                ///< bit 2 axis + side: beyond that face of the cell lies a coarser one
};

// An array of a million takes no pass over its memory before it is written.
static_assert(std::is_trivially_default_constructible_v<LatticeBlock>);

struct LatticeRange {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

struct SurfaceLattice {
    Array<LatticeBlock> blocks;  ///< brick by brick, in each by place
    Array<LatticeRange> bricks;  ///< the blocks of each of Mesh::bricks
};

}  // namespace meniscus
