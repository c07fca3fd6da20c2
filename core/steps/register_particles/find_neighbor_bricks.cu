// Step 1 on the GPU: the bricks of particles near every brick of base cells.
#include "particles/neighbor_bricks.hpp"

#include "engine/cuda/warp.hpp"
#include "steps/cuda_steps.hpp"

namespace meniscus::cuda {
namespace {

__global__ void __launch_bounds__(block_threads) find_each_neighbor_brick(const __grid_constant__ State state) {
    // The slots of all bricks may be more than 2^32.
    constexpr std::uint64_t of_brick = particle_level_count * NeighborBricks::slots;
    GridLoop{}.each<std::uint64_t>(of_brick * state.count(Resource::bricks), [&](std::uint64_t i) {
        const auto b = static_cast<std::uint32_t>(i / of_brick);
        const auto of_this = static_cast<unsigned>(i % of_brick);
        const unsigned level = of_this / NeighborBricks::slots;
        const int slot = static_cast<int>(of_this % NeighborBricks::slots);
        NeighborBricks& near = state.neighbor_bricks[std::uint64_t{particle_level_count} * b + level];
        const ParticleSetView set = state.set(level);
        if (set.cells.brick_count == 0) return;
        const Units3 origin = base_cell_origin(state.bricks[b].corner());
        const Int3 lowest = NeighborBricks::lowest(set, origin);
        const std::int64_t edge = set.cell_units * brick_size;
        if (slot == 0) {
            near.cells_per_unit = 1.0F / static_cast<float>(set.cell_units);
            near.corner[0] = static_cast<std::int32_t>(lowest.x * edge - origin.x);
            near.corner[1] = static_cast<std::int32_t>(lowest.y * edge - origin.y);
            near.corner[2] = static_cast<std::int32_t>(lowest.z * edge - origin.z);
        }
        near.brick[slot] = set.cells.find(lowest + NeighborBricks::offset(slot));
    });
}

}  // namespace

void find_neighbor_bricks(const State& state, const Launcher& launch) {
    launch(particle_level_count * NeighborBricks::slots * state.capacity[Resource::bricks], block_threads,
           find_each_neighbor_brick, state);
}

}  // namespace meniscus::cuda
