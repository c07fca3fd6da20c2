// The particles near a box, visited by all lanes of a warp for points that lie together. A warp fetches them side by
// side and keeps those within reach of the box. What lies beyond its support adds exactly zero, so that the sums are
// the same.
#pragma once

#include "engine/cuda/candidate_windows.hpp"
#include "engine/cuda/near_particles.hpp"

namespace meniscus::cuda {

/// Shared memory of one warp. group: candidates whose loads are under way at once, which takes registers.
template <class Kernel, unsigned group>
class BoxParticles {
public:
    /// Calls visit(OneCandidate) in all lanes, in the order of summation, and a few times for what adds nothing. All
    /// lanes call it. box: units from the corner of base cell `origin`, in the brick of base cells `brick`.
    template <class Visit>
    __device__ void for_each(const State& f, std::uint32_t brick, const Int3& origin, const UnitBox& box,
                             const Visit& visit) {
        const unsigned lane = lane_index();
#pragma unroll 1
        for (unsigned k = 0; k < particle_level_count; ++k) {
            const LevelParticles<Kernel> level(f, k);
            if (level.set.cells.brick_count == 0) continue;
            const RowsNear rows(level.set, f.near_bricks[std::uint64_t{particle_level_count} * brick + k],
                                place_in_brick(index_in_brick(origin)), box);
            const BoxTest<Kernel> test(box, level.set.reach());
            const unsigned count = rows.count();
            unsigned listed = 0;
            for (unsigned first_row = 0; first_row < count; first_row += warp_threads) {
                const ParticlesOfRows<Kernel> particles(level, rows, first_row);
                std::uint32_t start = 0;
                do {
                    // Two windows' loads are under way at once.
                    OneCandidate c[2];
                    for (unsigned w = 0; w < 2; ++w) c[w] = particles.candidate(start + w * warp_threads + lane);
                    for (unsigned w = 0; w < 2; ++w) {
                        const bool reaches =
                            start + w * warp_threads + lane < particles.total && test(c[w].particle, c[w].fall);
                        const unsigned all = __ballot_sync(all_lanes, reaches ? 1 : 0);
                        if (reaches)
                            list_.set(listed + static_cast<unsigned>(__popc(all & ((1U << lane) - 1))), c[w].particle,
                                      c[w].fall, 0);
                        listed += static_cast<unsigned>(__popc(all));
                    }
                    start += 2 * warp_threads;
                    const bool is_last = first_row + warp_threads >= count && start >= particles.total;
                    if (!is_last && listed <= room - 2 * warp_threads) continue;
                    visit_listed(level, listed, visit);
                    listed = 0;
                } while (start < particles.total);
            }
        }
    }

private:
    static constexpr unsigned room = 4 * warp_threads;

    template <class Visit>
    __device__ void visit_listed(const LevelParticles<Kernel>& level, unsigned listed, const Visit& visit) {
        // Those that fill up the last group add nothing anywhere: they have no weight, and are far away.
        if (lane_index() + 1 < group) list_.set(listed + lane_index(), {1e9F, 0.0F, 0.0F, 0.0F}, 1.0F, 0);
        __syncwarp();
        for (unsigned j = 0; j < listed; j += group) {
            OneCandidate c[group];
            for (unsigned g = 0; g < group; ++g)
                c[g] = {list_.particles[j + g], list_.fall(j + g), level.set.support, level.inverse_support, 0};
            for (unsigned g = 0; g < group; ++g) visit(c[g]);
        }
        __syncwarp();
    }

    ParticleList<Kernel, false, room + group> list_;
};

}  // namespace meniscus::cuda
