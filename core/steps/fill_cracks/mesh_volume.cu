// The volume of the finished mesh on the GPU.
#include "engine/cuda/block_counter.hpp"
#include "steps/cuda_steps.hpp"
#include "steps/fill_cracks/volume.hpp"

namespace meniscus::cuda {
namespace {

/// One thread for every triangle. A sum of integers: the order of the additions decides nothing.
__global__ void __launch_bounds__(block_threads) add_volumes(const __grid_constant__ State state) {
    __shared__ BlockCounter counter;
    Counter total = 0;
    GridLoop{}.each(state.count(Resource::triangles), [&](std::uint32_t t) {
        total += static_cast<Counter>(sixfold_volume(state.vertices, state.triangles[t]));
    });
    counter.add(&state.counts->sixfold_volume, total);
}

}  // namespace

void measure_volume(const State& state, const Launcher& launch) {
    launch(state.capacity[Resource::triangles], block_threads, add_volumes, state);
}

}  // namespace meniscus::cuda
