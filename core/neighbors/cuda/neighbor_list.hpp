// Neighbors of one level in the shared memory of a warp, all lanes of which visit each of them.
#pragma once

#include "engine/cuda/warp.hpp"
#include "neighbors/cuda/neighbor.hpp"

namespace meniscus::cuda {

/// has_ranks: whether Neighbor::rank is known.
template <class Kernel, bool has_ranks, unsigned size>
struct NeighborList {
    alignas(16) float4 particles[size];
    alignas(16) float falls[Kernel::has_own_support ? size : 4];
    std::uint32_t ranks[has_ranks ? size : 1];

    __device__ float fall(unsigned i) const { return Kernel::has_own_support ? falls[i] : 0.0F; }
    __device__ std::uint32_t rank(unsigned i) const { return has_ranks ? ranks[i] : 0; }
    __device__ void set(unsigned i, const float4& particle, float fall, std::uint32_t rank) {
        particles[i] = particle;
        if constexpr (Kernel::has_own_support) falls[i] = fall;
        if constexpr (has_ranks) ranks[i] = rank;
    }
    /// Adds those of the lanes that have one to the first `count`, in the order of lanes.
    __device__ void add(unsigned& count, bool has_one, const float4& particle, float fall, std::uint32_t rank) {
        const unsigned added = __ballot_sync(all_lanes, has_one ? 1 : 0);
        if (has_one) set(count + lanes_below(added), particle, fall, rank);
        count += static_cast<unsigned>(__popc(added));
    }
    /// Calls visit(Neighbor) in all lanes for the first `count`, and for fewer than `group` that add nothing.
    /// group: neighbors whose loads are under way at once, which takes registers; there is room for group - 1 more.
    template <unsigned group, class Visit>
    __device__ void for_each(unsigned count, float support, float inverse_support, const Visit& visit) {
        // Those that make up the last group have no weight, and are far away.
        if (lane_index() + 1 < group) set(count + lane_index(), {1e9F, 0.0F, 0.0F, 0.0F}, 1.0F, 0);
        __syncwarp();
        for (unsigned j = 0; j < count; j += group) {
            Neighbor neighbors[group];
            for (unsigned g = 0; g < group; ++g)
                neighbors[g] = {particles[j + g], fall(j + g), support, inverse_support, rank(j + g)};
            for (unsigned g = 0; g < group; ++g) visit(neighbors[g]);
        }
        // The next ones take the place of these.
        __syncwarp();
    }
};

}  // namespace meniscus::cuda
