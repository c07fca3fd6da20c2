// Step 5 on the GPU, and the order of the mesh.
#include "steps/count_triangles/count_triangles.hpp"

#include <array>
#include <tuple>

#include "engine/cuda/block_counter.hpp"
#include "engine/cuda/warp.hpp"
#include "engine/cuda/warp_signs.hpp"
#include "steps/cuda_steps.hpp"
#include "steps/fill_cracks/fill_cracks.hpp"
#include "steps/fill_cracks/warp_cracks.hpp"

namespace meniscus::cuda {
namespace {

__global__ void __launch_bounds__(block_threads) list_band(const __grid_constant__ State state) {
    __shared__ BlockCounter counter;
    const BlocksView blocks = state.blocks();
    std::uint32_t band_cells[3] = {0, 0, 0};
    GridLoop{}.each_by_blocks(blocks.count, [&](std::uint32_t b, bool exists) {
        const bool is_own = exists && state.settings.part.owns(blocks.coordinate(b));
        const int level = is_own ? blocks.level[b] : 0;
        for (int l = 1; l <= 3; ++l) band_cells[l - 1] += level == l ? 1 : 0;
        const std::uint32_t at =
            counter.take_places(&state.counts->listed[static_cast<int>(List::band)], level != 0 ? 1 : 0);
        if (level != 0)
            state.band_cells[at] = b;
        else if (exists)
            state.triangles_before[b] = {};
    });
    for (int l = 0; l < 3; ++l) counter.add(&state.counts->band_cells[l], band_cells[l]);
}

/// One warp for every four cells of the band.
__global__ void __launch_bounds__(block_threads) count_cells(const __grid_constant__ State state) {
    __shared__ std::uint8_t triangles[cube_case_count];
    __shared__ WarpSigns all_signs[block_warps];
    __shared__ BlockCounter counter;
    static_assert(block_threads == cube_case_count);
    triangles[threadIdx.x] = state.cube_table[threadIdx.x].triangles;
    __syncthreads();
    WarpSigns& signs = all_signs[warp_in_block()];
    const BlocksView blocks = state.blocks();
    const std::uint32_t band = same_in_all_lanes(state.listed(List::band));
    Counter total[3] = {};  // of this lane's cells, by level
    each_by_warp((band + closed_cells_a_warp - 1) / closed_cells_a_warp, [&](std::uint32_t group) {
        const CellsOfLanes cells(blocks, state.band_cells, band, closed_cells_a_warp * group);
        signs.put(blocks, cells);
        __syncwarp();
        // Two cells are counted in the halves of a word.
        std::uint32_t count[closed_cells_a_warp / 2] = {};
        for (unsigned c = 0; c < closed_cells_a_warp; ++c) {
            const SubcellPair pair = signs.subcells_of_lane(c);
            for (const std::uint32_t cube_case : pair.cube_case) count[c / 2] += triangles[cube_case] << (c % 2 * 16);
        }
        for (std::uint32_t& two : count) two = sum_of_lanes(two);
        // The next cells take the place of these.
        __syncwarp();
        if (!cells.exists || lane_index() % 8 != 0) return;
        const unsigned cell = lane_index() / 8;
        const std::uint32_t own = (cell < 2 ? count[0] : count[1]) >> (cell % 2 * 16) & 0xFFFF;
        state.triangles_before[cells.block] = {};
        state.triangles_before[cells.block].of[cells.level - 1] = own;
        // By constants alone: an array that is not in registers would be in slow local memory.
        for (int level = 1; level <= 3; ++level) total[level - 1] += cells.level == level ? own : 0;
    });
    for (int level = 1; level <= 3; ++level) counter.add(&state.counts->triangles[level - 1], total[level - 1]);
}

/// A lane finds out whether a cell has a coarser neighbor; those that have go through the warp four at a time.
__global__ void __launch_bounds__(block_threads) count_cracks(const __grid_constant__ State state) {
    __shared__ ClosedPoints points;
    __shared__ WarpSigns all_signs[block_warps];
    __shared__ WarpCracks all_cracks[block_warps];
    __shared__ std::uint32_t all_fine[block_warps][warp_threads];
    __shared__ BlockCounter counter;
    const std::uint32_t* const of_level = state.counts->band_cells;
    // Cells of one level have no cracks; beside a part's own cells lie others.
    if (state.settings.part.is_whole &&
        (of_level[0] != 0 ? 1 : 0) + (of_level[1] != 0 ? 1 : 0) + (of_level[2] != 0 ? 1 : 0) < 2)
        return;
    points.fill();
    __syncthreads();
    WarpSigns& signs = all_signs[warp_in_block()];
    WarpCracks& cracks = all_cracks[warp_in_block()];
    std::uint32_t(&fine)[warp_threads] = all_fine[warp_in_block()];
    const BlocksView blocks = state.blocks();
    constexpr int crack = static_cast<int>(TriangleLevel::crack);
    Counter total = 0;
    GridLoop{}.each_together(state.listed(List::band), [&](std::uint32_t i, bool exists) {
        const std::uint32_t block = exists ? state.band_cells[i] : 0;
        const std::uint32_t listed = __ballot_sync(all_lanes, exists && has_coarser_neighbor(blocks, block) ? 1 : 0);
        if ((listed >> lane_index() & 1) != 0) fine[lanes_below(listed)] = block;
        __syncwarp();
        const auto n = static_cast<std::uint32_t>(__popc(listed));
        for (std::uint32_t first = 0; first < n; first += closed_cells_a_warp) {
            const CellsOfLanes cells(blocks, fine, n, first);
            signs.put(blocks, cells);
            const std::uint32_t faces = cracks.list(blocks, cells);
            __syncwarp();
            // A cell has six faces of four subfaces: a byte counts their triangles.
            static_assert(6 * 4 * std::tuple_size_v<decltype(CrackCase::edges)> / 3 < 256);
            std::uint32_t counts = 0;
            cracks.for_each_subface_together(signs, faces, [&](const CrackSubface& subface) {
                if (!subface.exists) return;
                const std::uint32_t own = state.crack_table[subface.crack_case(points, signs)].triangles;
                counts += own << (8 * subface.cell);
            });
            counts = sum_of_lanes(counts);
            const std::uint32_t count = lane_index() % 8 == 0 ? counts >> lane_index() & 0xFF : 0;
            const std::uint32_t at =
                take_places(&state.counts->listed[static_cast<int>(List::cracks)], count != 0 ? 1 : 0);
            if (count != 0) {
                state.triangles_before[cells.block].of[crack] = count;
                state.cracked_cells[at] = cells.block;
                total += count;
            }
            // The next cells take the place of these.
            __syncwarp();
        }
        // The next cells are listed in the place of these.
        __syncwarp();
    });
    counter.add(&state.counts->triangles[crack], total);
}

/// The mesh's order: by level, by brick within a level. Every thread adds up the few levels for itself.
__global__ void __launch_bounds__(block_threads) order_by_level_and_brick(const __grid_constant__ State state) {
    Counter first[triangle_level_count];
    Counter total = 0;
    for (std::size_t level = 0; level < triangle_level_count; ++level) {
        first[level] = total;
        total += state.counts->triangles[level];
    }
    if (blockIdx.x == 0 && threadIdx.x == 0) {
        for (std::size_t level = 0; level < triangle_level_count; ++level)
            state.counts->first_triangle[level] = static_cast<std::uint32_t>(first[level]);
        // Step 6 asks whether there is room, once vertices are counted, too.
        state.counts->needed[static_cast<int>(Resource::triangles)] = total;
    }
    const std::uint32_t bricks = state.count(Resource::bricks);
    const std::uint32_t blocks = state.count(Resource::blocks);
    GridLoop{}.each(bricks, [&](std::uint32_t b) {
        const LevelCounts begin = state.triangles_before[state.bricks[b].first];
        const LevelCounts end = state.triangles_before[b + 1 < bricks ? state.bricks[b + 1].first : blocks];
        const Int3 at = state.bricks[b].coordinate;
        MeshBrick brick;
        brick.coordinate = {at.x, at.y, at.z};
        for (std::size_t level = 0; level < triangle_level_count; ++level)
            brick.ranges[level] = {static_cast<std::uint32_t>(first[level]) + begin.of[level],
                                   end.of[level] - begin.of[level]};
        state.mesh_bricks[b] = brick;
    });
}

}  // namespace

void count_triangles(const State& state, const Launcher& launch) {
    const std::uint64_t blocks = state.capacity[Resource::blocks];
    launch(blocks, block_threads, list_band, state);
    launch(blocks, block_warps * closed_cells_a_warp, count_cells, state);
    launch(blocks, block_threads, count_cracks, state);
    // Blocks are numbered brick by brick: one sum orders the mesh by brick and by cell within a brick, for all levels.
    exclusive_sum(state.scratch_memory(), state.triangles_before, blocks + 1, launch.stream);
    launch(state.capacity[Resource::bricks], block_threads, order_by_level_and_brick, state);
}

}  // namespace meniscus::cuda
