// Algorithm 3 on the GPU: a warp for every four cells with cracks, a lane for every subface.
#include "steps/fill_cracks/fill_cracks.hpp"

#include "engine/cuda/warp.hpp"
#include "steps/cuda_steps.hpp"
#include "steps/fill_cracks/warp_cracks.hpp"
#include "steps/place_vertices/vertex_counts.hpp"

namespace meniscus::cuda {
namespace {

__global__ void __launch_bounds__(block_threads, 4) fill_listed(const __grid_constant__ State state) {
    __shared__ ClosedPoints points;
    __shared__ WarpSigns all_signs[block_warps];
    __shared__ VertexCounts all_vertices[block_warps];
    __shared__ WarpCracks all_cracks[block_warps];
    __shared__ std::uint32_t all_first[block_warps][closed_cells_a_warp];
    points.fill();
    __syncthreads();
    WarpSigns& signs = all_signs[warp_in_block()];
    VertexCounts& vertices = all_vertices[warp_in_block()];
    WarpCracks& cracks = all_cracks[warp_in_block()];
    // Where in the mesh a cell's triangles would begin if the warp's first subface were its own.
    std::uint32_t(&first)[closed_cells_a_warp] = all_first[warp_in_block()];
    const BlocksView blocks = state.blocks();
    constexpr int crack = static_cast<int>(TriangleLevel::crack);
    const std::uint32_t n = same_in_all_lanes(state.listed(List::cracks));
    each_by_warp((n + closed_cells_a_warp - 1) / closed_cells_a_warp, [&](std::uint32_t group) {
        const CellsOfLanes cells(blocks, state.cracked_cells, n, closed_cells_a_warp * group);
        signs.put(blocks, cells);
        vertices.put(blocks, cells);
        const std::uint32_t faces = cracks.list(blocks, cells);
        if (cells.exists && lane_index() % 8 == 0)
            first[lane_index() / 8] =
                state.counts->first_triangle[crack] + state.triangles_before[cells.block].of[crack];
        __syncwarp();
        std::uint32_t done = 0;
        cracks.for_each_subface_together(signs, faces, [&](const CrackSubface& subface) {
            const CrackCase& pattern = state.crack_table[subface.crack_case(points, signs)];
            const unsigned triangles = subface.exists ? pattern.triangles : 0;
            std::uint32_t all = 0;
            const std::uint32_t at = done + sum_of_lanes_below(triangles, all);
            if (subface.exists && subface.is_first) first[subface.cell] -= at;
            __syncwarp();
            Triangle* const out = state.triangles + first[subface.cell] + at;
            for (unsigned t = 0; t < triangles; ++t)
                for (unsigned corner = 0; corner < 3; ++corner) {
                    const unsigned edge = pattern.edges[3 * t + corner];
                    const bool is_along_u = edge < 6;
                    const unsigned start =
                        is_along_u ? subface.point(edge % 2, edge / 2) : subface.point((edge - 6) % 3, (edge - 6) / 3);
                    // The patterns are oriented for the fine cell lying up the axis.
                    out[t][subface.side == 0 ? corner : 2 - corner] =
                        vertices.vertex(points, signs, subface.cell, start, is_along_u ? subface.u() : subface.v(),
                                        subface.stride_shift);
                }
            done += all;
        });
        // The next cells take the place of these.
        __syncwarp();
    });
}

}  // namespace

void fill_cracks(const State& state, const Launcher& launch) {
    launch(state.capacity[Resource::blocks], block_warps * closed_cells_a_warp, fill_listed, state);
}

}  // namespace meniscus::cuda
