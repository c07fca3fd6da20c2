// Step 7 on the GPU: a warp lists the triangles of a few cells, then each lane writes one.
#include "steps/emit_triangles/emit_triangles.hpp"

#include "engine/cuda/warp.hpp"
#include "steps/cuda_steps.hpp"
#include "steps/emit_triangles/triangle_rows.hpp"
#include "steps/place_vertices/vertex_counts.hpp"

namespace meniscus::cuda {
namespace {

/// A triangle to be written: its subcell's place (7 bits), its row of TriangleRows (11), its cell (2), and log2 of the
/// cell's stride.
using ListedTriangle = std::uint32_t;
constexpr unsigned row_at = 7, cell_at = 18, stride_at = 20;
static_assert(closed_cells_a_warp == 4);

/// A list in shared memory, with room for the cells of nearly all frames. One cell has 64 * 5 triangles at most.
struct WarpTriangles {
    static constexpr unsigned room = 512;
    ListedTriangle list[room];
    std::uint32_t first[closed_cells_a_warp];  ///< where in the mesh the list's entry 0 lies, were it that cell's
};

/// The triangles of a cell that a lane lists.
struct TrianglesOfLane {
    ListedTriangle first[2];  ///< first triangle of each of its subcells
    unsigned count[2];

    __device__ TrianglesOfLane(const TriangleRows& table, const SubcellPair& pair, unsigned cell,
                               unsigned stride_shift) {
        for (unsigned i = 0; i < 2; ++i) {
            first[i] = (SubcellPair::place() + i) | TriangleRows::most * pair.cube_case[i] << row_at | cell << cell_at |
                       stride_shift << stride_at;
            count[i] = table.triangles[pair.cube_case[i]];
        }
    }
    TrianglesOfLane() = default;
    __device__ unsigned all() const { return count[0] + count[1]; }
    /// Writes the list's entries from `out` on.
    __device__ void list(ListedTriangle* out) const {
        for (unsigned i = 0; i < 2; ++i) {
            for (unsigned t = 0; t < TriangleRows::most; ++t)
                if (t < count[i]) out[t] = first[i] + (t << row_at);
            out += count[i];
        }
    }
};

/// One warp for every four cells of the band.
__global__ void __launch_bounds__(block_threads, 4) emit_cells(const __grid_constant__ State state) {
    __shared__ TriangleRows table;
    __shared__ ClosedPoints points;
    __shared__ WarpSigns all_signs[block_warps];
    __shared__ VertexCounts all_vertices[block_warps];
    __shared__ WarpTriangles all_triangles[block_warps];
    table.fill(state.cube_table);
    points.fill();
    __syncthreads();
    WarpSigns& signs = all_signs[warp_in_block()];
    VertexCounts& vertices = all_vertices[warp_in_block()];
    WarpTriangles& triangles = all_triangles[warp_in_block()];
    const BlocksView blocks = state.blocks();
    const unsigned lane = lane_index();
    const std::uint32_t band = same_in_all_lanes(state.listed(List::band));
    each_by_warp((band + closed_cells_a_warp - 1) / closed_cells_a_warp, [&](std::uint32_t group) {
        const CellsOfLanes cells(blocks, state.band_cells, band, closed_cells_a_warp * group);
        signs.put(blocks, cells);
        vertices.put(blocks, cells);
        __syncwarp();
        TrianglesOfLane own[closed_cells_a_warp];
        for (unsigned c = 0; c < closed_cells_a_warp; ++c)
            own[c] = TrianglesOfLane(table, signs.subcells_of_lane(c), c, signs.stride_shift[c]);
        // Two cells are counted in the halves of a word.
        std::uint32_t below[closed_cells_a_warp];
        std::uint32_t begin[closed_cells_a_warp + 1] = {};
        for (unsigned c = 0; c < closed_cells_a_warp; c += 2) {
            std::uint32_t all = 0;
            const std::uint32_t two = sum_of_lanes_below(own[c].all() | own[c + 1].all() << 16, all);
            below[c] = two & 0xFFFF;
            below[c + 1] = two >> 16;
            begin[c + 1] = begin[c] + (all & 0xFFFF);
            begin[c + 2] = begin[c + 1] + (all >> 16);
        }
        // One cell at a time where there is no room for all.
        const bool together = begin[closed_cells_a_warp] <= WarpTriangles::room;
        for (unsigned round = 0; round < (together ? 1 : closed_cells_a_warp); ++round) {
            std::uint32_t listed = together ? begin[closed_cells_a_warp] : 0;
            for (unsigned c = 0; c < closed_cells_a_warp; ++c) {
                if (!together && c != round) continue;
                if (!together) listed = begin[c + 1] - begin[c];
                const std::uint32_t first = together ? begin[c] : 0;
                own[c].list(triangles.list + first + below[c]);
                if (lane == 8 * c && cells.exists)
                    triangles.first[c] = state.counts->first_triangle[cells.level - 1] +
                                         state.triangles_before[cells.block].of[cells.level - 1] - first;
            }
            __syncwarp();
            for (unsigned t = lane; t < listed; t += warp_threads) {
                const ListedTriangle entry = triangles.list[t];
                const std::uint32_t row = table.row[entry >> row_at & ((1U << (cell_at - row_at)) - 1)];
                const unsigned cell = entry >> cell_at & (closed_cells_a_warp - 1);
                const unsigned stride_shift = entry >> stride_at;
                const unsigned place = entry & ((1U << row_at) - 1);
                Triangle& out = state.triangles[triangles.first[cell] + t];
                for (unsigned k = 0; k < 3; ++k) {
                    const std::uint32_t edge = row >> (10 * k);
                    out[k] = vertices.vertex(points, signs, cell, place + ((edge & 31) << stride_shift), edge >> 5 & 3,
                                             stride_shift);
                }
            }
            // The next ones take the place of these.
            __syncwarp();
        }
    });
}

}  // namespace

void emit_triangles(const State& state, const Launcher& launch) {
    launch(state.capacity[Resource::blocks], block_warps * closed_cells_a_warp, emit_cells, state);
}

}  // namespace meniscus::cuda
