#include "steps/adjust_levels/adjust_levels.hpp"

#include "steps/adjust_levels/sweeps.hpp"
#include "steps/cuda_steps.hpp"

namespace meniscus::cuda {
namespace {

__global__ void __launch_bounds__(block_threads) balance_and_promote(const __grid_constant__ Frame f) {
    Sweeps sweeps(f);
    sweeps.adjust_levels();
}

}  // namespace

void adjust_levels(const Frame& frame, const Launcher& launch) {
    launch.cooperative(frame.capacity[Resource::blocks], balance_and_promote, frame);
}

}  // namespace meniscus::cuda
