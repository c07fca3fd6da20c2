// Step 7 on the GPU.
#include "steps/emit_triangles/emit_triangles.hpp"

#include "engine/cuda/warp.hpp"
#include "steps/cuda_steps.hpp"
#include "steps/shared_closed_cell.hpp"

namespace meniscus::cuda {
namespace {

/// One warp for every cell of the band, one lane for every subcell.
__global__ void __launch_bounds__(block_threads, 3) emit_cells(const __grid_constant__ State f) {
    __shared__ ClosedCell shared[block_warps];
    ClosedCell& cell = shared[warp_in_block()];
    const BlocksView blocks = f.blocks();
    each_by_warp(f.listed(List::band), [&](std::uint32_t i) {
        const std::uint32_t block = f.band_cells[i];
        const int level = blocks.level[block];
        const int stride = level_stride(level);
        const std::uint32_t own = block_of_lane(blocks, block);
        const SubcellCorners corners = subcell_corners(blocks, own, stride);
        if (corners.mixed(stride) == 0) return;
        if (lane_index() < 8) cell.block[lane_index()] = own;
        __syncwarp();
        const SubcellVertices vertex{blocks, cell, stride};
        std::uint32_t next = f.counts->first_triangle[level - 1] + f.triangles_before[block].of[level - 1];
        for_each_subcell_together(corners, stride, [&](int bit, int cube_case) {
            const CubeCase& pattern = f.cube_table[cube_case];
            std::uint32_t all = 0;
            Triangle* out = f.triangles + next + sum_of_lanes_below(pattern.triangles, all);
            for (int t = 0; t < pattern.triangles; ++t, ++out)
                for (int corner = 0; corner < 3; ++corner)
                    (*out)[static_cast<std::size_t>(corner)] =
                        vertex(bit, pattern.edges[static_cast<std::size_t>(3 * t + corner)]);
            next += all;
        });
        // The next cell takes the place of this one.
        __syncwarp();
    });
}

}  // namespace

void emit_triangles(const State& state, const Launcher& launch) {
    launch(state.capacity[Resource::blocks], block_warps, emit_cells, state);
}

}  // namespace meniscus::cuda
