// The smooth field's supports and weights, for all particles of a frame.
#include "steps/register_particles/supports.hpp"

#include "engine/cuda/block_counter.hpp"
#include "engine/cuda/sort_key.hpp"
#include "steps/cuda_steps.hpp"
#include "steps/register_particles/particle_sums.hpp"

namespace meniscus::cuda {
namespace {

/// Whether a particle is alone, and this part's to count.
__device__ bool is_own_spray(const State& state, std::uint32_t i) {
    const SortKey& key = state.keys[i];
    return is_spray(state.sums[i], state.settings.smooth) &&
           lies_in_own_cell(particle_key(key), state.settings.cell_units[key_level(key)], state.settings.part);
}

/// Also counts the particles alone, and marks them where they are to be listed.
__global__ void __launch_bounds__(block_threads) fit_kernels(const __grid_constant__ State state) {
    __shared__ BlockCounter counter;
    const std::uint32_t n = state.particle_count();
    Counter spray = 0;
    GridLoop{}.each(state.capacity.particles, [&](std::uint32_t i) {
        const bool is_alone = i < n && is_spray(state.sums[i], state.settings.smooth);
        const bool is_counted = is_alone && is_own_spray(state, i);
        if (is_counted) ++spray;
        if (state.settings.lists_spray) state.spray_before[i] = is_counted ? 1 : 0;
        if (i >= n) return;
        const Poly6 kernel = is_alone && state.settings.leaves_out_spray
                                 ? Poly6::none()
                                 : fitted_kernel(state.sums[i], key_level(state.keys[i]), state.settings.smooth);
        state.particles[i].w = kernel.weight;
        state.falls[i] = kernel.fall;
    });
    counter.add(&state.counts->spray_particles, spray);
}

__global__ void __launch_bounds__(block_threads) list_spray(const __grid_constant__ State state) {
    GridLoop{}.each(state.particle_count(), [&](std::uint32_t i) {
        if (!is_own_spray(state, i)) return;
        const unsigned level = key_level(state.keys[i]);
        state.spray[state.spray_before[i]] =
            spray_point(particle_key(state.keys[i]), state.settings.cell_units[level], state.settings.units_per_length);
    });
}

__global__ void __launch_bounds__(block_threads) lift_kernels(const __grid_constant__ State state) {
    GridLoop{}.each(state.particle_count(), [&](std::uint32_t i) {
        const Poly6 kernel =
            lifted_kernel({state.particles[i].w, state.falls[i]}, state.sums[i], state.settings.smooth);
        state.particles[i].w = kernel.weight;
        state.falls[i] = kernel.fall;
    });
}

}  // namespace

void fit_supports(const State& state, const Launcher& launch) {
    const std::uint64_t particles = state.capacity.particles;
    sum_at_particles<Company>(state, launch);
    launch(particles, block_threads, fit_kernels, state);
    if (state.settings.lists_spray) {
        exclusive_sum(state.scratch_memory(), state.spray_before, particles, launch.stream);
        launch(particles, block_threads, list_spray, state);
    }
    sum_at_particles<Poly6>(state, launch);
    launch(particles, block_threads, lift_kernels, state);
}

}  // namespace meniscus::cuda
