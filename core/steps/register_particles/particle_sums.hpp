// Sums at the places of particles on the GPU, a thread for each.
#pragma once

#include "engine/cuda/candidates.hpp"
#include "engine/cuda/launch.hpp"
#include "engine/cuda/long_loop.hpp"
#include "engine/cuda/sort_key.hpp"
#include "engine/cuda/warp.hpp"

namespace meniscus::cuda {

/// Poly6 takes more registers than fit three blocks.
template <class Kernel>
inline constexpr int blocks_of_sums = std::is_same_v<Kernel, CubicSpline> ? 3 : 2;

template <class Kernel>
__global__ void __launch_bounds__(block_threads, blocks_of_sums<Kernel>)
    sum_at_each_particle(const __grid_constant__ State f) {
    LongLoop loop(f);
    GridLoop{}.each(f.particle_count(), [&](std::uint32_t i) {
        if (!loop.goes_on()) return;
        const unsigned level = key_level(f.keys[i]);
        const ParticleKey key = particle_key(f.keys[i]);
        const Units3 origin = cell_corner(key.cell, f.settings.cell_units[level]);
        const Units3 place = place_in_cell(key);
        const float x[1] = {static_cast<float>(place.x)}, y[1] = {static_cast<float>(place.y)},
                    z[1] = {static_cast<float>(place.z)};
        float sum[1] = {0.0F};
        for_each_candidate<Kernel>(f, origin, {{x[0], y[0], z[0]}, {x[0], y[0], z[0]}},
                                   [&](const OneCandidate& c) { sum_values<Kernel, 1>(c.view(), x, y, z, sum); });
        f.sums[i] = sum[0];
    });
}

/// Into State::sums. Kernel: CubicSpline, Poly6 or Company.
template <class Kernel>
void sum_at_particles(const State& state, const Launcher& launch) {
    launch(state.capacity.particles, block_threads, sum_at_each_particle<Kernel>, state);
}

}  // namespace meniscus::cuda
