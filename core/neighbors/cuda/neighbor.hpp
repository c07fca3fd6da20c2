// The particles near a box, in the order of summation. Those beyond their support add exactly zero, so that each way to
// find them gives the same sums.
#pragma once

#include <type_traits>

#include "engine/cuda/state.hpp"
#include "field/kernels.hpp"
#include "field/sums.hpp"

namespace meniscus::cuda {

/// One neighbor, also as a list of one.
struct Neighbor {
    float4 particle;
    float fall;  ///< Poly6 only
    float support;
    float inverse_support;
    std::uint32_t rank;  ///< index among the frame's sorted particles
    __device__ NeighborView view() const {
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

    __device__ LevelParticles(const State& state, unsigned level)
        : set(state.set(level)),
          particles(state.particles),
          falls(state.falls),
          inverse_support(state.settings.inverse_support[level]) {
        if (std::is_same_v<Kernel, Company>) set.support = state.settings.company_support[level];
    }
    /// The particles from the first-th on. Those next to it are then found at fixed distances.
    __device__ LevelParticles from(std::uint32_t first) const {
        LevelParticles here = *this;
        here.particles += first;
        if (std::is_same_v<Kernel, Poly6>) here.falls += first;
        return here;
    }
    /// Particle i, relative to the corner of its support cell's brick.
    __device__ Neighbor neighbor(std::uint32_t i) const {
        const float fall = std::is_same_v<Kernel, Poly6> ? falls[i] : 0.0F;
        return {particles[i], fall, set.support, inverse_support, i};
    }
    __device__ Neighbor neighbor(std::uint32_t i, const float* shift) const {
        Neighbor moved = neighbor(i);
        moved.particle.x += shift[0];
        moved.particle.y += shift[1];
        moved.particle.z += shift[2];
        return moved;
    }
};

/// Calls visit(Neighbor) for all particles near a box, level by level: one thread alone, for a point far from
/// others.
template <class Kernel, class Visit>
__device__ inline void for_each_neighbor(const State& state, const Units3& origin, const UnitBox& box,
                                         const Visit& visit) {
    for (unsigned k = 0; k < particle_level_count; ++k) {
        const LevelParticles<Kernel> level(state, k);
        if (level.set.cells.brick_count == 0) continue;
        NoBrickHints hints;
        level.set.for_each_run_near(origin, box, hints,
                                    [&](std::uint32_t begin, std::uint32_t end, const float* shift) {
                                        for (std::uint32_t i = begin; i < end; ++i) visit(level.neighbor(i, shift));
                                    });
    }
}

}  // namespace meniscus::cuda
