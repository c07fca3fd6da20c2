#include "steps/count_triangles/count_triangles.hpp"

#include "engine/cuda/closed_cell.hpp"
#include "engine/cuda/warp.hpp"
#include "steps/cuda_steps.hpp"
#include "steps/fill_cracks/fill_cracks.hpp"

namespace meniscus::cuda {
namespace {

__global__ void __launch_bounds__(block_threads) list_band(const __grid_constant__ Frame f) {
    const BlocksView blocks = f.blocks();
    std::uint32_t band_cells[3] = {0, 0, 0};
    GridLoop{}.each_together(blocks.count, [&](std::uint32_t b, bool exists) {
        const int level = exists ? blocks.level[b] : 0;
        for (int l = 1; l <= 3; ++l)
            band_cells[l - 1] += static_cast<std::uint32_t>(__popc(__ballot_sync(all_lanes, level == l ? 1 : 0)));
        const std::uint32_t at = take_places(&f.counts->listed[static_cast<int>(List::band)], level != 0 ? 1 : 0);
        if (level != 0)
            f.band[at] = b;
        else if (exists)
            f.triangles_before[b] = {};
    });
    if (lane_index() == 0)
        for (int l = 0; l < 3; ++l)
            if (band_cells[l] != 0) atomicAdd(&f.counts->band_cells[l], band_cells[l]);
}

/// One warp for every cell of the band.
__global__ void __launch_bounds__(block_threads) count_cells(const __grid_constant__ Frame f) {
    const BlocksView blocks = f.blocks();
    Counter total[3] = {0, 0, 0};
    each_by_warp(f.listed(List::band), [&](std::uint32_t i) {
        const std::uint32_t block = f.band[i];
        const int level = blocks.level[block];
        const int stride = level_stride(level);
        const SubcellCorners corners = subcell_corners(blocks, block_of_lane(blocks, block), stride);
        std::uint32_t own = 0;
        for_each_subcell_together(corners, stride,
                                  [&](int, int cube_case) { own += f.cube_table[cube_case].triangles; });
        std::uint32_t count = 0;
        sum_of_lanes_below(own, count);
        if (lane_index() != 0) return;
        f.triangles_before[block] = {{level == 1 ? count : 0, level == 2 ? count : 0, level == 3 ? count : 0, 0}};
        for (int l = 1; l <= 3; ++l) total[l - 1] += level == l ? count : 0;
    });
    if (lane_index() == 0)
        for (int l = 0; l < 3; ++l)
            if (total[l] != 0) atomicAdd(&f.counts->triangles[l], total[l]);
}

__global__ void __launch_bounds__(block_threads, 3) count_cracks(const __grid_constant__ Frame f) {
    const BlocksView blocks = f.blocks();
    constexpr int crack = static_cast<int>(TriangleLevel::crack);
    Counter total = 0;
    GridLoop{}.each_together(f.listed(List::band), [&](std::uint32_t i, bool exists) {
        const std::uint32_t block = exists ? f.band[i] : 0;
        const std::uint32_t count = exists ? count_crack_triangles(blocks, block, f.crack_table) : 0;
        const std::uint32_t at = take_places(&f.counts->listed[static_cast<int>(List::cracks)], count != 0 ? 1 : 0);
        if (count == 0) return;
        f.triangles_before[block].of[crack] = count;
        f.cracked[at] = block;
        total += count;
    });
    add_of_lanes(&f.counts->triangles[crack], total);
}

}  // namespace

void count_triangles(const Frame& frame, const Launcher& launch) {
    const std::uint64_t blocks = frame.capacity[Resource::blocks];
    launch(blocks, block_threads, list_band, frame);
    launch(blocks, block_warps, count_cells, frame);
    launch(blocks, block_threads, count_cracks, frame);
    // Blocks are numbered brick by brick: one sum orders the mesh by brick and by cell within a brick, for all levels.
    exclusive_sum(frame.scratch_memory(), frame.triangles_before, blocks + 1, launch.stream);
}

}  // namespace meniscus::cuda
