// Sums at the places of particles on the GPU, a few lanes for each.
#pragma once

#include "engine/cuda/launch.hpp"
#include "engine/cuda/long_loop.hpp"
#include "engine/cuda/sharing_lanes.hpp"
#include "engine/cuda/sort_key.hpp"
#include "engine/cuda/warp.hpp"
#include "neighbors/cuda/neighbor.hpp"

namespace meniscus::cuda {

/// Adds particles from the first-th on to the sum at a point: G of each of the lanes that share it, or where not
/// are_all, the `left` ones that a run has left. Each lane finds the strengths of its own, and all of them add all up
/// in their order. A lane fetches all before it adds the first: if it waited for one after another it would be idle
/// most of the time.
template <class Kernel, unsigned G, bool are_all, unsigned count>
__device__ inline void add_particles(const LevelParticles<Kernel>& level, std::uint32_t first, std::uint32_t left,
                                     const SharingLanes<count>& lanes, const float (&at)[3], float& sum) {
    const LevelParticles<Kernel> here = level.from(first + (are_all ? lanes.own : 0));
    Neighbor neighbors[G];
    for (unsigned g = 0; g < G; ++g) {
        const unsigned i = g * count + lanes.own;
        neighbors[g] = here.neighbor(are_all ? g * count : i < left ? i : 0);
    }
#ifdef __CUDA_ARCH__
    // Else the compiler moves each load to the use of its value, and the waits lie one behind another.
    for (unsigned g = 0; g < G; ++g) asm volatile("" : "+f"(neighbors[g].fall));
#endif
    float strength[G];
    for (unsigned g = 0; g < G; ++g)
        strength[g] = Kernel::of(neighbors[g].view(), 0)
                          .strength(at[0] - neighbors[g].particle.x, at[1] - neighbors[g].particle.y,
                                    at[2] - neighbors[g].particle.z);
    for (unsigned g = 0; g < G; ++g) {
        float of_lane[count];
        for (unsigned l = 0; l < count; ++l) of_lane[l] = lanes.from(strength[g], l);
        for (unsigned l = 0; l < count; ++l) {
            auto share = Kernel::of(neighbors[g].view(), 0);
            if constexpr (!decltype(share)::has_own_support) share.weight = lanes.from(share.weight, l);
            if (are_all || g * count + l < left) sum = share.add_strength(sum, of_lane[l]);
        }
    }
}

/// `count` lanes for every particle.
template <class Kernel, unsigned count>
__global__ void __launch_bounds__(block_threads, 3) sum_at_each_particle(const __grid_constant__ State state) {
    // None if the frame has stopped, which must not part the lanes.
    const std::uint32_t n = same_in_all_lanes(state.particle_count());
    LongLoop loop(state);
    const SharingLanes<count> lanes;
    const GridLoop threads;
    for (std::uint64_t i = threads.first / count; i < n; i += threads.step / count) {
        // Lanes that share a particle end together: each waits for the values of the others.
        if (lanes.from(lanes.own == 0 && loop.goes_on() ? 1 : 0, 0) == 0) return;
        const unsigned own_level = key_level(state.keys[i]);
        const ParticleKey key = particle_key(state.keys[i]);
        const Units3 origin = cell_corner(key.cell, state.settings.cell_units[own_level]);
        const Units3 place = place_in_cell(key);
        const float x = static_cast<float>(place.x), y = static_cast<float>(place.y), z = static_cast<float>(place.z);
        float sum = 0.0F;
        for (unsigned k = 0; k < particle_level_count; ++k) {
            const LevelParticles<Kernel> level(state, k);
            if (level.set.cells.brick_count == 0) continue;
            NoBrickHints hints;
            level.set.for_each_run_near(
                origin, {{x, y, z}, {x, y, z}}, hints, [&](std::uint32_t begin, std::uint32_t end, const float* shift) {
                    // Whole units, so that this is exact.
                    const float at[3] = {x - shift[0], y - shift[1], z - shift[2]};
                    // As many as registers hold.
                    constexpr unsigned group = (std::is_same_v<Kernel, CubicSpline> ? 2 : 4) / (count == 1 ? 1 : 2);
                    std::uint32_t j = begin;
#pragma unroll 1
                    for (; j + group * count <= end; j += group * count)
                        add_particles<Kernel, group, true>(level, j, end - j, lanes, at, sum);
                    if (j < end) add_particles<Kernel, group, false>(level, j, end - j, lanes, at, sum);
                });
        }
        if (lanes.own == 0) state.sums[i] = sum;
    }
}

/// Puts the sums into State::sums. Kernel: CubicSpline, Poly6 or Company.
template <class Kernel>
void sum_at_particles(const State& state, const Launcher& launch) {
    launch_for_particles(state, launch, sum_at_each_particle<Kernel, lanes_to_share>, sum_at_each_particle<Kernel, 1>);
}

}  // namespace meniscus::cuda
