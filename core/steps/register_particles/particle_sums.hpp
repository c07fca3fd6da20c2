// Sums at the places of particles on the GPU, a thread for each.
#pragma once

#include "engine/cuda/candidates.hpp"
#include "engine/cuda/launch.hpp"
#include "engine/cuda/long_loop.hpp"
#include "engine/cuda/sort_key.hpp"
#include "engine/cuda/warp.hpp"

namespace meniscus::cuda {

/// Adds G particles from the first-th on to the sum at a point. All are fetched before the first is added: a thread
/// that waits for one after another is idle most of the time.
template <class Kernel, int G>
__device__ inline void add_particles(const LevelParticles<Kernel>& level, std::uint32_t first, const float (&at)[3],
                                     float& sum) {
    const LevelParticles<Kernel> here = level.from(first);
    OneCandidate c[G];
    for (unsigned g = 0; g < G; ++g) c[g] = here.candidate(g);
#ifdef __CUDA_ARCH__
    // Else the compiler moves each load to where its value is used, and the waits lie one behind another.
    for (unsigned g = 0; g < G; ++g) asm volatile("" : "+f"(c[g].fall));
#endif
    float strength[G];
    for (int g = 0; g < G; ++g)
        strength[g] = Kernel::of(c[g].view(), 0)
                          .strength(at[0] - c[g].particle.x, at[1] - c[g].particle.y, at[2] - c[g].particle.z);
    for (int g = 0; g < G; ++g) sum = Kernel::of(c[g].view(), 0).add_strength(sum, strength[g]);
}

template <class Kernel>
__global__ void __launch_bounds__(block_threads, 3) sum_at_each_particle(const __grid_constant__ State f) {
    LongLoop loop(f);
    GridLoop{}.each(f.particle_count(), [&](std::uint32_t i) {
        if (!loop.goes_on()) return;
        const unsigned own_level = key_level(f.keys[i]);
        const ParticleKey key = particle_key(f.keys[i]);
        const Units3 origin = cell_corner(key.cell, f.settings.cell_units[own_level]);
        const Units3 place = place_in_cell(key);
        const float x = static_cast<float>(place.x), y = static_cast<float>(place.y), z = static_cast<float>(place.z);
        float sum = 0.0F;
        for (unsigned k = 0; k < particle_level_count; ++k) {
            const LevelParticles<Kernel> level(f, k);
            if (level.set.cells.brick_count == 0) continue;
            NoBrickHints hints;
            level.set.for_each_run_near(origin, {{x, y, z}, {x, y, z}}, hints,
                                        [&](std::uint32_t begin, std::uint32_t end, const float* shift) {
                                            // Whole units, so that this is exact.
                                            const float at[3] = {x - shift[0], y - shift[1], z - shift[2]};
                                            constexpr int group = std::is_same_v<Kernel, CubicSpline> ? 2 : 4;
                                            std::uint32_t j = begin;
#pragma unroll 1
                                            for (; j + group <= end; j += group)
                                                add_particles<Kernel, group>(level, j, at, sum);
#pragma unroll 1
                                            for (; j < end; ++j) add_particles<Kernel, 1>(level, j, at, sum);
                                        });
        }
        f.sums[i] = sum;
    });
}

/// Into State::sums. Kernel: CubicSpline, Poly6 or Company.
template <class Kernel>
void sum_at_particles(const State& state, const Launcher& launch) {
    launch(state.capacity.particles, block_threads, sum_at_each_particle<Kernel>, state);
}

}  // namespace meniscus::cuda
