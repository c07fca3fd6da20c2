// Neighbors of a cluster, in the shared memory of the warp that has it, and those of them near each of its parts:
// in the order of summation. What lies beyond its support adds exactly zero, so that each way to leave it out gives the
// same sums.
#pragma once

#include "engine/cuda/state.hpp"
#include "engine/cuda/warp.hpp"
#include "neighbors/cuda/cluster.hpp"
#include "neighbors/cuda/neighbor.hpp"
#include "neighbors/cuda/neighbor_list.hpp"
#include "neighbors/cuda/neighbor_rows.hpp"

namespace meniscus::cuda {

/// Whether particles may reach a box.
template <class Kernel>
class BoxTest {
public:
    __device__ BoxTest(const UnitBox& box, float reach) : reach2_(reach * reach) {
        for (int axis = 0; axis < 3; ++axis) {
            middle_[axis] = 0.5F * (box.low[axis] + box.high[axis]);
            half_[axis] = 0.5F * (box.high[axis] - box.low[axis]);
        }
    }
    __device__ bool operator()(const float4& p, float fall) const {
        const float x = gap(p.x, 0), y = gap(p.y, 1), z = gap(p.z, 2);
        const float d2 = fma(x, x, fma(y, y, z * z));
        // A little farther than its own support, since distances are rounded.
        return Kernel::has_own_support ? fall * d2 <= p.w * 1.0001F : d2 <= reach2_;
    }

private:
    __device__ float gap(float v, int axis) const { return max(fabsf(v - middle_[axis]) - half_[axis], 0.0F); }

    float middle_[3], half_[3];
    float reach2_;
};

/// Shared memory of one warp.
template <class Kernel, bool has_ranks = false>
class ClusterNeighbors {
public:
    /// Takes in the particles near a box (units from the cluster's corner), but for the first `skipped` of them.
    /// Returns how many there are, which may be more than skipped + room.
    __device__ unsigned gather(const State& state, const Cluster& cluster, const UnitBox& box, unsigned skipped) {
        const unsigned lane = lane_index();
        __syncwarp();
        unsigned found = 0;
#pragma unroll 1
        for (unsigned k = 0; k < particle_level_count; ++k) {
            const LevelParticles<Kernel> level(state, k);
            if (level.set.cells.brick_count != 0) {
                const NeighborBricks& near =
                    state.neighbor_bricks[std::uint64_t{particle_level_count} * cluster.brick + k];
                const NeighborRows rows(level.set, near, cluster.corner, box);
                const BoxTest<Kernel> test(box, level.set.reach());
                for_each_particle_of_rows(level, rows, [&](const Neighbor& neighbor, bool exists) {
                    const bool reaches = exists && test(neighbor.particle, neighbor.fall);
                    const unsigned all = __ballot_sync(all_lanes, reaches ? 1 : 0);
                    const unsigned at = found + lanes_below(all) - skipped;
                    if (reaches && at < room) all_.set(at, neighbor.particle, neighbor.fall, neighbor.rank);
                    found += static_cast<unsigned>(__popc(all));
                });
            }
            if (lane == 0) end_[k] = found < skipped ? 0 : found - skipped < room ? found - skipped : room;
        }
        __syncwarp();
        return found;
    }

    /// Calls visit(Neighbor) in all lanes for each of those taken in that is near a box within that of gather().
    template <class Visit>
    __device__ void for_each_near(const State& state, const UnitBox& box, const Visit& visit) {
        const unsigned lane = lane_index();
        unsigned begin = 0;
#pragma unroll 1
        for (unsigned k = 0; k < particle_level_count; ++k) {
            const unsigned end = end_[k];
            if (begin == end) continue;
            const float support = state.settings.support[k];
            const float inverse_support = state.settings.inverse_support[k];
            const BoxTest<Kernel> test(box, ParticleSetView::reach_of(support));
            while (begin < end) {
                unsigned chosen = 0;
                for (; begin < end && chosen <= most_chosen - warp_threads; begin += warp_threads) {
                    const unsigned i = begin + lane;
                    float4 particle{};
                    float fall = 0.0F;
                    bool near = false;
                    if (i < end) {
                        particle = all_.particles[i];
                        fall = all_.fall(i);
                        near = test(particle, fall);
                    }
                    chosen_.add(chosen, near, particle, fall, near ? all_.rank(i) : 0);
                }
                chosen_.template for_each<group>(chosen, support, inverse_support, visit);
            }
            begin = end;
        }
    }

    UnitBox whole;  ///< box of all parts, see PartNeighbors
    static constexpr unsigned room = has_ranks ? 128 : 224;

private:
    static constexpr unsigned most_chosen = 64;
    /// With ranks, neighbors are visited one by one: numbers of attributes may be such that zero times one is not
    /// zero.
    static constexpr unsigned group = has_ranks ? 1 : 4;

    NeighborList<Kernel, has_ranks, room> all_;
    NeighborList<Kernel, has_ranks, most_chosen + group> chosen_;
    std::uint32_t end_[particle_level_count];  ///< end of each level's neighbors in all_
};

/// The neighbors of the parts of a cluster: all at once where they fit, else part by part and a piece at a time.
template <class Kernel, bool has_ranks = false>
class PartNeighbors {
public:
    /// box: holds all parts; units from the cluster's corner.
    __device__ PartNeighbors(const State& state, const Cluster& cluster, const UnitBox& box,
                             ClusterNeighbors<Kernel, has_ranks>& shared)
        : state_(state), cluster_(cluster), shared_(shared) {
        // Asked for once and then seldom: not for registers.
        if (lane_index() == 0) shared.whole = box;
        __syncwarp();
    }

    /// Calls visit(Neighbor) for all near a part's box.
    template <class Visit>
    __device__ void for_each_near(const UnitBox& box, const Visit& visit) {
        for_each_piece(box, [&] { shared_.for_each_near(state_, box, visit); });
    }
    /// Calls visit() for each piece of those near a part's box that `shared` holds at a time.
    template <class Visit>
    __device__ void for_each_piece(const UnitBox& box, const Visit& visit) {
        unsigned skipped = 0;
        unsigned found = 0;
        do {
            if (held_ != Held::all) {
                const bool tries_all = held_ == Held::none;
                // By coordinates: a choice between the boxes themselves would keep them in memory.
                UnitBox from;
                for (int axis = 0; axis < 3; ++axis) {
                    from.low[axis] = tries_all ? shared_.whole.low[axis] : box.low[axis];
                    from.high[axis] = tries_all ? shared_.whole.high[axis] : box.high[axis];
                }
                found = shared_.gather(state_, cluster_, from, skipped);
                held_ = tries_all && found <= shared_.room ? Held::all : Held::piece;
                if (tries_all && held_ == Held::piece) continue;
            }
            visit();
            skipped += shared_.room;
        } while (skipped < found);
    }

private:
    enum class Held : std::uint8_t { none, all, piece };

    const State& state_;
    const Cluster& cluster_;
    ClusterNeighbors<Kernel, has_ranks>& shared_;
    Held held_ = Held::none;
};

}  // namespace meniscus::cuda
