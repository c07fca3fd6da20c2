// Lists of the blocks to be sampled next.
#pragma once

#include <cstdint>

#include "engine/cuda/block_counter.hpp"
#include "engine/cuda/state.hpp"
#include "engine/cuda/warp.hpp"
#include "neighbors/cuda/cluster.hpp"

namespace meniscus::cuda {

/// Lists the clusters of blocks with wanted points that have no value. Blocks that gain points move to new room at the
/// end of the samples; their old room stays unused until the next frame. A block for which there is no room is left
/// out. Each thread gives one block or none; no block is given twice. take: as in list_clusters().
template <class Take>
__device__ void list_if_wanted(const State& state, List list, std::uint32_t b, BlockMask wanted, const Take& take) {
    BlockMask missing = 0;
    BlockMask sampled = 0;
    if (b != no_index) {
        sampled = state.sampled[b];
        state.wanted_points[b] = wanted;
        missing = wanted & ~sampled;
    }
    const std::uint32_t room = missing == 0 ? 0 : static_cast<std::uint32_t>(popcount(missing | sampled));
    const Counter first = take(&state.counts->needed[static_cast<int>(Resource::samples)], room);
    const bool fits = room != 0 && first + room <= state.capacity[Resource::samples];
    if (fits) {
        state.old_first_sample[b] = state.first_sample[b];
        state.first_sample[b] = static_cast<std::uint32_t>(first);
    } else if (room != 0) {
        state.wanted_points[b] = sampled;
    }
    list_clusters(state, list, b, fits, take);
}
/// The same for all blocks, by the whole grid; wanted(block) is asked once for each.
template <class Wanted>
__device__ void list_wanted_points(const State& state, List list, BlockCounter& counter, const Wanted& wanted) {
    const BlocksView blocks = state.blocks();
    GridLoop{}.each_by_blocks(blocks.count, [&](std::uint32_t b, bool exists) {
        list_if_wanted(state, list, exists ? b : no_index, exists ? wanted(blocks, b) : 0,
                       [&](auto* places, std::uint32_t n) { return counter.take_places(places, n); });
    });
}

}  // namespace meniscus::cuda
