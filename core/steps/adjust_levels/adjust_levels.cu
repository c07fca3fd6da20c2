// Step 3 on the GPU: sweeps over all cells in one cooperative kernel.
#include "steps/adjust_levels/adjust_levels.hpp"

#include "engine/cuda/warp.hpp"
#include "steps/adjust_levels/sweeps.hpp"
#include "steps/cuda_steps.hpp"

namespace meniscus::cuda {
namespace {

/// One thread for every word of a brick.
__global__ void __launch_bounds__(block_threads) list_level_sets(const __grid_constant__ State state) {
    GridLoop{}.each(std::uint64_t{Brick::words} * state.count(Resource::bricks), [&](std::uint32_t i) {
        const WordLevels cells(state.bricks[i / Brick::words], static_cast<int>(i % Brick::words), state.level);
        for (int level = 1; level <= 3; ++level) state.at_least[level][i] = cells.at_least[level];
        state.raised[i] = 0;
        if (i % 4 == 0) state.marked_clusters[i / 4] = 0;
    });
}

__global__ void __launch_bounds__(block_threads, 4) balance_and_promote(const __grid_constant__ State state) {
    Sweeps(state, Team::grid(), AllWords(state)).adjust_levels();
}

}  // namespace

void collect_level_sets(const State& state, const Launcher& launch) {
    launch(Brick::words * state.capacity[Resource::bricks], block_threads, list_level_sets, state);
}

void adjust_levels(const State& state, const Launcher& launch) {
    launch.cooperative(state.capacity[Resource::blocks], balance_and_promote, state);
}

}  // namespace meniscus::cuda
