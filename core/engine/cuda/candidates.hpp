// The particles near a box, in the order of summation. Those beyond their support add exactly zero, so that each way to
// find them gives the same sums.
#pragma once

#include "engine/cuda/state.hpp"
#include "engine/cuda/warp.hpp"
#include "field/sums.hpp"

namespace meniscus::cuda {

/// One particle as a list of candidates.
struct OneCandidate {
    float4 particle;
    float inverse_support;
    __device__ CandidateView view() const {
        return {&particle.x, &particle.y, &particle.z, &particle.w, 1, inverse_support};
    }
};

/// Calls visit(OneCandidate) for all particles near a box, level by level: one thread alone, for a point far from
/// others.
template <class Visit>
__device__ inline void for_each_candidate(const State& f, const Units3& origin, const UnitBox& box,
                                          const Visit& visit) {
    for (unsigned k = 0; k < particle_level_count; ++k) {
        const ParticleSetView set = f.set(k);
        if (set.cells.brick_count == 0) continue;
        NoBrickHints hints;
        set.for_each_run_near(origin, box, hints, [&](std::uint32_t begin, std::uint32_t end, const float* shift) {
            for (std::uint32_t i = begin; i < end; ++i) {
                const float4 p = f.particles[i];
                visit(
                    OneCandidate{{p.x + shift[0], p.y + shift[1], p.z + shift[2], p.w}, f.settings.inverse_support[k]});
            }
        });
    }
}

/// Shared memory of one warp, for particles on their way to all of its lanes.
struct Staging {
    static constexpr unsigned size = 2 * warp_threads;
    float4 particles[size];
};

/// The same, by all lanes of a warp for points that lie together: they fetch particles side by side, keep those within
/// reach of the box, and each of them visits all.
template <class Visit>
__device__ inline void for_each_staged_candidate(const State& f, const Units3& origin, const UnitBox& box,
                                                 Staging& staging, const Visit& visit) {
    const unsigned lane = lane_index();
    for (unsigned k = 0; k < particle_level_count; ++k) {
        const ParticleSetView set = f.set(k);
        if (set.cells.brick_count == 0) continue;
        const float reach2 = set.reach() * set.reach();
        unsigned staged = 0;
        const auto visit_staged = [&] {
            __syncwarp();
            for (unsigned j = 0; j < staged; ++j)
                visit(OneCandidate{staging.particles[j], f.settings.inverse_support[k]});
            __syncwarp();
            staged = 0;
        };
        NoBrickHints hints;
        set.for_each_run_near(origin, box, hints, [&](std::uint32_t begin, std::uint32_t end, const float* shift) {
            for (std::uint32_t start = begin; start < end; start += warp_threads) {
                float4 p{};
                bool near = false;
                if (start + lane < end) {
                    p = f.particles[start + lane];
                    p.x += shift[0];
                    p.y += shift[1];
                    p.z += shift[2];
                    const auto gap = [&](float v, int axis) {
                        return max(max(box.low[axis] - v, v - box.high[axis]), 0.0F);
                    };
                    const float x = gap(p.x, 0), y = gap(p.y, 1), z = gap(p.z, 2);
                    near = x * x + y * y + z * z <= reach2;
                }
                const unsigned all_near = __ballot_sync(all_lanes, near ? 1 : 0);
                if (near) staging.particles[staged + static_cast<unsigned>(__popc(all_near & ((1U << lane) - 1)))] = p;
                staged += static_cast<unsigned>(__popc(all_near));
                if (staged > Staging::size - warp_threads) visit_staged();
            }
        });
        visit_staged();
    }
}

}  // namespace meniscus::cuda
