// The color field's weights: mass over density, where a particle's density is the sum of the density field at its
// place.
#include "engine/cuda/warp.hpp"
#include "steps/cuda_steps.hpp"
#include "steps/register_particles/particle_sums.hpp"

namespace meniscus::cuda {
namespace {

__global__ void __launch_bounds__(block_threads) divide_weights(const __grid_constant__ State state) {
    GridLoop{}.each(state.particle_count(), [&](std::uint32_t i) { state.particles[i].w /= state.sums[i]; });
}

}  // namespace

void divide_weights_by_density(const State& state, const Launcher& launch) {
    // The value of the density field at a particle is a sum of the weights that it will divide: all are computed first.
    sum_at_particles<CubicSpline>(state, launch);
    launch(state.capacity.particles, block_threads, divide_weights, state);
}

}  // namespace meniscus::cuda
