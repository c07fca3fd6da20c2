// The color field's weights: mass over density, where a particle's density is the sum of the density field at its
// place.
#include "engine/cuda/candidates.hpp"
#include "engine/cuda/sort_key.hpp"
#include "engine/cuda/warp.hpp"
#include "steps/cuda_steps.hpp"

namespace meniscus::cuda {
namespace {

/// The value of the density field at a particle is the sum of the weights that it will divide: all are computed before
/// any is.
__global__ void __launch_bounds__(block_threads, 3) measure_densities(const __grid_constant__ State f) {
    GridLoop{}.each(f.particle_count(), [&](std::uint32_t i) {
        const unsigned level = key_level(f.keys[i]);
        const ParticleKey key = particle_key(f.keys[i]);
        const Units3 origin = cell_corner(key.cell, f.settings.cell_units[level]);
        constexpr std::uint64_t mask = (std::uint64_t{1} << place_axis_bits) - 1;
        const float x[1] = {static_cast<float>(key.place & mask)},
                    y[1] = {static_cast<float>(key.place >> place_axis_bits & mask)},
                    z[1] = {static_cast<float>(key.place >> (2 * place_axis_bits))};
        float sum[1] = {0.0F};
        for_each_candidate(f, origin, {{x[0], y[0], z[0]}, {x[0], y[0], z[0]}},
                           [&](const OneCandidate& c) { sum_values<1>(c.view(), x, y, z, sum); });
        f.densities[i] = sum[0];
    });
}

__global__ void __launch_bounds__(block_threads) divide_weights(const __grid_constant__ State f) {
    GridLoop{}.each(f.particle_count(), [&](std::uint32_t i) { f.particles[i].w /= f.densities[i]; });
}

}  // namespace

void divide_weights_by_density(const State& state, const Launcher& launch) {
    launch(state.capacity.particles, block_threads, measure_densities, state);
    launch(state.capacity.particles, block_threads, divide_weights, state);
}

}  // namespace meniscus::cuda
