// Clusters of 2 x 2 x 2 blocks, which share the particles near them: a warp takes one at a time.
#pragma once

#include "engine/cuda/long_loop.hpp"
#include "engine/cuda/state.hpp"
#include "engine/cuda/warp.hpp"

namespace meniscus::cuda {

inline constexpr unsigned cluster_blocks = 8;
inline constexpr int cluster_size = 2;  ///< blocks a side

/// The offset of a cluster's block from its lowest one, x running first.
__device__ inline Int3 cluster_step(unsigned i) {
    return {static_cast<int>(i & 1), static_cast<int>(i >> 1 & 1), static_cast<int>(i >> 2 & 1)};
}

/// A cluster's bit among those of the clusters that are listed.
struct ClusterMark {
    std::uint32_t* word;
    std::uint32_t bit;

    /// place: that of one of its blocks in the brick.
    __device__ ClusterMark(const State& state, std::uint32_t brick, unsigned place) {
        const unsigned cluster = (place >> 1 & 7) | (place >> 5 & 7) << 3 | (place >> 9 & 7) << 6;
        word = &state.marked_clusters[std::uint64_t{cluster_words} * brick + cluster / 32];
        bit = 1U << cluster % 32;
    }
};

/// Puts the clusters of some blocks on a list, each by one of its blocks. chosen: whether this thread's block is; a
/// block is chosen once. take: take_places() or BlockCounter's, whose callers must all call this.
template <class Take>
__device__ void list_clusters(const State& state, List list, std::uint32_t block, bool chosen, const Take& take) {
    bool is_first = false;
    if (chosen) {
        const ClusterMark mark(state, state.brick[block], state.place[block]);
        is_first = (atomicOr(mark.word, mark.bit) & mark.bit) == 0;
    }
    const std::uint32_t at = take(&state.counts->listed[static_cast<int>(list)], is_first ? 1 : 0);
    if (is_first) state.chosen[at] = block;
}

/// A cluster, or a part of one, as a warp sees it.
struct Cluster {
    std::uint32_t brick;
    Int3 corner;  ///< place of its lowest block in the brick
    std::uint32_t
        block;  ///< this lane's block, for the first eight lanes; no_index for others, and where no block is stored
    bool is_first_part;

    /// One of the 2^halvings parts of the cluster that holds a block.
    __device__ Cluster(const BlocksView& blocks, std::uint32_t member, unsigned part, unsigned halvings)
        : brick(blocks.brick[member]), is_first_part(part == 0) {
        const Int3 place = place_in_brick(blocks.place[member]);
        corner = {place.x & ~1, place.y & ~1, place.z & ~1};
        const Brick& of = blocks.grid.bricks[brick];
        const unsigned lane = lane_index();
        const int own = index_in_brick(corner + cluster_step(lane));
        const bool has_block = lane < cluster_blocks && lane >> (most_halvings - halvings) == part;
        block = has_block && of.holds(own) ? of.number(own) : no_index;
    }
    static constexpr unsigned most_halvings = 3;

    __device__ Int3 coordinate(const BlocksView& blocks) const { return blocks.grid.bricks[brick].corner() + corner; }
    /// Takes the mark of its list away: once for a cluster that was listed.
    __device__ void unmark(const State& state) const {
        if (!is_first_part || lane_index() != 0) return;
        const ClusterMark mark(state, brick, static_cast<unsigned>(index_in_brick(corner)));
        atomicAnd(mark.word, ~mark.bit);
    }
};

/// Calls visit(cluster) for all clusters on a list, each by all lanes of one warp. Where there are few clusters for a
/// warp, several warps take parts of one: the last cluster shall not keep all others waiting.
template <class Visit>
__device__ void each_listed_cluster(const State& state, const BlocksView& blocks, List list, const Visit& visit) {
    const std::uint32_t count = same_in_all_lanes(state.listed(list));
    const std::uint64_t warps = static_cast<std::uint64_t>(gridDim.x) * block_warps;
    unsigned halvings = 0;
    while (halvings < Cluster::most_halvings && std::uint64_t{count} << (halvings + 1) <= 4 * warps) ++halvings;
    LongLoop loop(state);
    each_by_warp(count << halvings, [&](std::uint32_t i) {
        if (!loop.goes_on_together()) return;
        visit(Cluster(blocks, state.chosen[i >> halvings], i & ((1U << halvings) - 1), halvings));
    });
}

}  // namespace meniscus::cuda
