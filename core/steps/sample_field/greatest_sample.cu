// The greatest sample on the GPU.
#include "engine/cuda/warp.hpp"
#include "steps/cuda_steps.hpp"
#include "steps/sample_field/greatest_sample.hpp"

namespace meniscus::cuda {
namespace {

/// One thread for every block. Values are not negative: their bits, as integers, have the order of the values.
__global__ void __launch_bounds__(block_threads) find_greatest(const __grid_constant__ State state) {
    const BlocksView blocks = state.blocks();
    std::uint32_t greatest = 0;
    GridLoop{}.each(blocks.count, [&](std::uint32_t b) {
        const std::uint32_t bits = __float_as_uint(greatest_of_block(blocks, b, state.settings));
        if (bits > greatest) greatest = bits;
    });
    if (greatest != 0) atomicMax(&state.counts->greatest_sample, greatest);
}

}  // namespace

void find_greatest_sample(const State& state, const Launcher& launch) {
    launch(state.capacity[Resource::blocks], block_threads, find_greatest, state);
}

}  // namespace meniscus::cuda
