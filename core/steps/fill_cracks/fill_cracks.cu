// Algorithm 3 on the GPU.
#include "steps/fill_cracks/fill_cracks.hpp"

#include "engine/cuda/warp.hpp"
#include "steps/cuda_steps.hpp"

namespace meniscus::cuda {
namespace {

/// One thread for every cell, which keeps its closed cell in shared memory: it is indexed by what the tables say.
__global__ void __launch_bounds__(block_threads, 2) fill_listed(const __grid_constant__ State f) {
    __shared__ ClosedCell cells[block_threads];
    ClosedCell& cell = cells[threadIdx.x];
    const BlocksView blocks = f.blocks();
    constexpr int crack = static_cast<int>(TriangleLevel::crack);
    GridLoop{}.each(f.listed(List::cracks), [&](std::uint32_t i) {
        const std::uint32_t block = f.cracked_cells[i];
        cell = ClosedCell(blocks, block);
        emit_crack_triangles(blocks, block, cell, f.crack_table,
                             f.triangles + f.counts->first_triangle[crack] + f.triangles_before[block].of[crack]);
    });
}

}  // namespace

void fill_cracks(const State& state, const Launcher& launch) {
    launch(state.capacity[Resource::blocks], block_threads, fill_listed, state);
}

}  // namespace meniscus::cuda
