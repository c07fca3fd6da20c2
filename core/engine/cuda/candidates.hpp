// The particles near a box, in the order of summation. Those beyond their support add exactly zero, so that each way to
// find them gives the same sums.
#pragma once

#include <type_traits>

#include "engine/cuda/state.hpp"
#include "engine/cuda/warp.hpp"
#include "field/kernels.hpp"
#include "field/sums.hpp"

namespace meniscus::cuda {

/// One particle as a list of candidates.
struct OneCandidate {
    float4 particle;
    float fall;  ///< Poly6 only
    float support;
    float inverse_support;
    std::uint32_t rank;  ///< in the frame's sorted particles
    __device__ CandidateView view() const {
        return {&particle.x, &particle.y, &particle.z, &particle.w, &fall, 1, support, inverse_support};
    }
};

/// The particles of a level as a kernel sees them: CubicSpline, Poly6 or Company.
template <class Kernel>
struct LevelParticles {
    ParticleSetView set;
    const float4* particles;
    const float* falls;
    float inverse_support;

    __device__ LevelParticles(const State& f, unsigned level)
        : set(f.set(level)),
          particles(f.particles),
          falls(f.falls),
          inverse_support(f.settings.inverse_support[level]) {
        if (std::is_same_v<Kernel, Company>) set.support = f.settings.company_support[level];
    }
    __device__ OneCandidate candidate(std::uint32_t i, const float* shift) const {
        const float4 p = particles[i];
        const float fall = std::is_same_v<Kernel, Poly6> ? falls[i] : 0.0F;
        return {{p.x + shift[0], p.y + shift[1], p.z + shift[2], p.w}, fall, set.support, inverse_support, i};
    }
};

/// Calls visit(OneCandidate) for all particles near a box, level by level: one thread alone, for a point far from
/// others.
template <class Kernel, class Visit>
__device__ inline void for_each_candidate(const State& f, const Units3& origin, const UnitBox& box,
                                          const Visit& visit) {
    for (unsigned k = 0; k < particle_level_count; ++k) {
        const LevelParticles<Kernel> level(f, k);
        if (level.set.cells.brick_count == 0) continue;
        NoBrickHints hints;
        level.set.for_each_run_near(origin, box, hints,
                                    [&](std::uint32_t begin, std::uint32_t end, const float* shift) {
                                        for (std::uint32_t i = begin; i < end; ++i) visit(level.candidate(i, shift));
                                    });
    }
}

/// Shared memory of one warp, for particles on their way to all of its lanes. has_ranks: whether OneCandidate::rank is
/// told.
template <class Kernel, bool has_ranks = false>
struct ParticleStaging {
    static constexpr unsigned size = 2 * warp_threads;
    float4 particles[size];
    float falls[Kernel::has_own_support ? size : 1];
    std::uint32_t ranks[has_ranks ? size : 1];
};

/// The same, by all lanes of a warp for points that lie together: they fetch particles side by side, keep those within
/// reach of the box, and each of them visits all.
template <class Kernel, bool has_ranks, class Visit>
__device__ inline void for_each_staged_candidate(const State& f, const Units3& origin, const UnitBox& box,
                                                 ParticleStaging<Kernel, has_ranks>& staging, const Visit& visit) {
    const unsigned lane = lane_index();
    for (unsigned k = 0; k < particle_level_count; ++k) {
        const LevelParticles<Kernel> level(f, k);
        if (level.set.cells.brick_count == 0) continue;
        const float reach2 = level.set.reach() * level.set.reach();
        unsigned staged = 0;
        const auto visit_staged = [&] {
            __syncwarp();
            for (unsigned j = 0; j < staged; ++j)
                visit(OneCandidate{staging.particles[j], Kernel::has_own_support ? staging.falls[j] : 0.0F,
                                   level.set.support, level.inverse_support, has_ranks ? staging.ranks[j] : 0});
            __syncwarp();
            staged = 0;
        };
        NoBrickHints hints;
        level.set.for_each_run_near(
            origin, box, hints, [&](std::uint32_t begin, std::uint32_t end, const float* shift) {
                for (std::uint32_t start = begin; start < end; start += warp_threads) {
                    OneCandidate c{};
                    bool near = false;
                    if (start + lane < end) {
                        c = level.candidate(start + lane, shift);
                        const auto gap = [&](float v, int axis) {
                            return max(max(box.low[axis] - v, v - box.high[axis]), 0.0F);
                        };
                        const float x = gap(c.particle.x, 0), y = gap(c.particle.y, 1), z = gap(c.particle.z, 2);
                        const float d2 = x * x + y * y + z * z;
                        // A little farther than its own support, since distances are rounded.
                        near = Kernel::has_own_support ? c.fall * d2 <= c.particle.w * 1.0001F : d2 <= reach2;
                    }
                    const unsigned all_near = __ballot_sync(all_lanes, near ? 1 : 0);
                    if (near) {
                        const unsigned at = staged + static_cast<unsigned>(__popc(all_near & ((1U << lane) - 1)));
                        staging.particles[at] = c.particle;
                        if constexpr (Kernel::has_own_support) staging.falls[at] = c.fall;
                        if constexpr (has_ranks) staging.ranks[at] = c.rank;
                    }
                    staged += static_cast<unsigned>(__popc(all_near));
                    if (staged > ParticleStaging<Kernel>::size - warp_threads) visit_staged();
                }
            });
        visit_staged();
    }
}

}  // namespace meniscus::cuda
