// The particles near a box, visited by all lanes of a warp for points that lie together. A warp fetches them side by
// side and keeps those within reach of the box. What lies beyond its support adds exactly zero, so that the sums are
// the same.
#pragma once

#include "neighbors/cuda/cluster_neighbors.hpp"
#include "neighbors/cuda/neighbor_list.hpp"
#include "neighbors/cuda/neighbor_rows.hpp"

namespace meniscus::cuda {

/// Shared memory of one warp. group: see NeighborList.
template <class Kernel, unsigned group>
class BoxNeighbors {
public:
    /// Calls visit(Neighbor) in all lanes, in the order of summation, and a few times for what adds nothing. All
    /// lanes call it. box: units from the corner of base cell `origin`, in the brick of base cells `brick`.
    template <class Visit>
    __device__ void for_each(const State& state, std::uint32_t brick, const Int3& origin, const UnitBox& box,
                             const Visit& visit) {
        const unsigned lane = lane_index();
#pragma unroll 1
        for (unsigned k = 0; k < particle_level_count; ++k) {
            const LevelParticles<Kernel> level(state, k);
            if (level.set.cells.brick_count == 0) continue;
            const NeighborRows rows(level.set, state.neighbor_bricks[std::uint64_t{particle_level_count} * brick + k],
                                    place_in_brick(index_in_brick(origin)), box);
            const BoxTest<Kernel> test(box, level.set.reach());
            const unsigned count = rows.count();
            unsigned listed = 0;
            for (unsigned first_row = 0; first_row < count; first_row += warp_threads) {
                const ParticlesOfRows<Kernel> particles(level, rows, first_row);
                std::uint32_t start = 0;
                do {
                    // The loads of two neighbors a lane are under way at once.
                    Neighbor neighbors[2];
                    for (unsigned w = 0; w < 2; ++w) neighbors[w] = particles.neighbor(start + w * warp_threads + lane);
                    for (unsigned w = 0; w < 2; ++w) {
                        const bool reaches = start + w * warp_threads + lane < particles.total &&
                                             test(neighbors[w].particle, neighbors[w].fall);
                        list_.add(listed, reaches, neighbors[w].particle, neighbors[w].fall, 0);
                    }
                    start += 2 * warp_threads;
                    const bool is_last = first_row + warp_threads >= count && start >= particles.total;
                    if (!is_last && listed <= room - 2 * warp_threads) continue;
                    list_.template for_each<group>(listed, level.set.support, level.inverse_support, visit);
                    listed = 0;
                } while (start < particles.total);
            }
        }
    }

private:
    static constexpr unsigned room = 4 * warp_threads;

    NeighborList<Kernel, false, room + group> list_;
};

}  // namespace meniscus::cuda
