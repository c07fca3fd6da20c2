// The borders of a part on the GPU: a warp for every brick and neighbor of it.
#include "steps/part_borders/part_borders.hpp"

#include "engine/cuda/warp.hpp"
#include "steps/cuda_steps.hpp"

namespace meniscus::cuda {
namespace {

__global__ void __launch_bounds__(block_threads) hash_each_border(const __grid_constant__ State state) {
    const BlocksView blocks = state.blocks();
    each_by_warp(neighbor_slots * state.count(Resource::bricks), [&](std::uint32_t i) {
        const std::uint32_t brick = i / neighbor_slots;
        const auto slot = static_cast<int>(i % neighbor_slots);
        WordHash hash{};
        if (is_seam(state.settings.part, state.bricks[brick].coordinate, slot)) {
            const FacingCells cells(slot);
            for (int cell = static_cast<int>(lane_index()); cell < cells.count(); cell += warp_threads)
                add_cell_beside_seam(hash, blocks, state.raise_times, brick, cells.place(cell), slot);
        }
        for (std::uint64_t& sum : hash.of)
            for (int distance = warp_threads / 2; distance > 0; distance /= 2)
                sum += __shfl_xor_sync(all_lanes, sum, distance);
        if (lane_index() == 0) state.border_hashes[i] = hash;
    });
}

}  // namespace

void hash_borders(const State& state, const Launcher& launch) {
    launch(neighbor_slots * state.capacity[Resource::bricks], block_warps, hash_each_border, state);
}

}  // namespace meniscus::cuda
