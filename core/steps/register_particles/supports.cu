// The smooth field's supports and weights, for all particles of a frame.
#include "steps/register_particles/supports.hpp"

#include "engine/cuda/sort_key.hpp"
#include "engine/cuda/warp.hpp"
#include "steps/cuda_steps.hpp"
#include "steps/register_particles/particle_sums.hpp"

namespace meniscus::cuda {
namespace {

__global__ void __launch_bounds__(block_threads) fit_kernels(const __grid_constant__ State f) {
    GridLoop{}.each(f.particle_count(), [&](std::uint32_t i) {
        const Poly6 kernel = fitted_kernel(f.sums[i], key_level(f.keys[i]), f.settings.smooth);
        f.particles[i].w = kernel.weight;
        f.falls[i] = kernel.fall;
    });
}

__global__ void __launch_bounds__(block_threads) lift_kernels(const __grid_constant__ State f) {
    GridLoop{}.each(f.particle_count(), [&](std::uint32_t i) {
        const Poly6 kernel = lifted_kernel({f.particles[i].w, f.falls[i]}, f.sums[i], f.settings.smooth);
        f.particles[i].w = kernel.weight;
        f.falls[i] = kernel.fall;
    });
}

}  // namespace

void fit_supports(const State& state, const Launcher& launch) {
    const std::uint64_t particles = state.capacity.particles;
    sum_at_particles<Company>(state, launch);
    launch(particles, block_threads, fit_kernels, state);
    sum_at_particles<Poly6>(state, launch);
    launch(particles, block_threads, lift_kernels, state);
}

}  // namespace meniscus::cuda
