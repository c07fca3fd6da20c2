// Brick::count() by the lanes of a warp.
#pragma once

#include <cstdint>

#include "engine/cuda/warp.hpp"
#include "lattice/brick_grid.hpp"

namespace meniscus::cuda {

/// Counts the words of a brick, two by each lane, which has last written them itself; returns the number of members to
/// all lanes.
__device__ inline std::uint32_t count_by_warp(Brick& brick) {
    static_assert(Brick::words == 2 * warp_threads);
    std::uint32_t total = 0;
    for (unsigned first = 0; first < 2; ++first) {
        const unsigned w = first * warp_threads + lane_index();
        std::uint32_t members = 0;
        const std::uint32_t before =
            total + sum_of_lanes_below(static_cast<std::uint32_t>(popcount(brick.occupied[w])), members);
        brick.rank[w] = static_cast<std::uint16_t>(before);
        total += members;
    }
    return total;
}

}  // namespace meniscus::cuda
