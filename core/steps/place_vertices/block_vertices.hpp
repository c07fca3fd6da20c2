// The vertices of one block on the CPU.
#pragma once

#include <cstddef>
#include <cstdint>

#include "lattice/blocks.hpp"
#include "neighbors/cpu/field_source.hpp"

namespace meniscus::cpu {

/// The vertices of one block, in the order of their numbers. Arrays have room for whole lanes.
struct BlockVertices {
    std::size_t count = 0;
    std::size_t first[4];                                 ///< index of every axis' first vertex, and the end
    std::uint8_t bit[max_points];                         ///< lower end of the edge
    alignas(64) float low[max_points], high[max_points];  ///< field values at the edge's ends
    alignas(64) float iso[max_points];                    ///< value that the vertex takes, where it is moved
    alignas(64) float offset[max_points];                 ///< offset from the lower end, in steps of c / 2^bits
};

/// Lists the vertices of a block whose edges are known; offsets are not set.
void find_vertices(const BlocksView& blocks, std::uint32_t block, BlockVertices& vertices);

inline bool is_low_inside(const BlocksView& blocks, std::uint32_t block, const BlockVertices& vertices, std::size_t i) {
    return (blocks.inside[block] >> vertices.bit[i] & 1) != 0;
}

}  // namespace meniscus::cpu
