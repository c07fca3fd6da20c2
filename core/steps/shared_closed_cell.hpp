// A closed cell shared among the lanes of a warp: each looks up one of its blocks, then takes some of its subcells, so
// that none needs a table of its own.
#pragma once

#include "engine/cuda/warp.hpp"
#include "steps/count_triangles/count_triangles.hpp"
#include "steps/place_vertices/place_vertices.hpp"

namespace meniscus::cuda {

/// Lane i < 8 returns the closed cell's block i.
__device__ inline std::uint32_t block_of_lane(const BlocksView& blocks, std::uint32_t block) {
    const unsigned i = lane_index() & 7;
    return blocks.neighbor(block, {static_cast<int>(i & 1), static_cast<int>(i >> 1 & 1), static_cast<int>(i >> 2)});
}

/// The signs of a closed cell's subcells, in all lanes.
__device__ inline SubcellCorners subcell_corners(const BlocksView& blocks, std::uint32_t own_block_of_lane,
                                                 int stride) {
    const BlockMask own = blocks.inside_or_none(own_block_of_lane);
    BlockMask inside[8];
    for (int i = 0; i < 8; ++i) inside[i] = __shfl_sync(all_lanes, own, i);
    return SubcellCorners(inside, stride);
}

/// Calls visit(bit of the subcell's lower corner, its case) in all lanes at once, lane by lane for neighboring bits;
/// case 0 where the surface does not pass.
template <class Visit>
__device__ inline void for_each_subcell_together(const SubcellCorners& corners, int stride, const Visit& visit) {
    const BlockMask mixed = corners.mixed(stride);
    for (unsigned half = 0; half < 2; ++half) {
        if ((mixed >> (32 * half) & all_lanes) == 0) continue;
        const int bit = static_cast<int>(lane_index() + 32 * half);
        visit(bit, (mixed >> bit & 1) != 0 ? corners.cube_case(bit) : 0);
    }
}

}  // namespace meniscus::cuda
