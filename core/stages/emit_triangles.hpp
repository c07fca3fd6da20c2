// Step 7: the triangles of a base cell, from the marching-cubes table.
#pragma once

#include <cstdint>

#include "lattice/host_device.hpp"
#include "meniscus/mesh.hpp"
#include "stages/blocks.hpp"
#include "stages/count_triangles.hpp"
#include "stages/place_vertices.hpp"

namespace meniscus {

/// The corner (x + 2 y + 4 z) at which an edge of the cube starts.
MENISCUS_HD constexpr int edge_start(int edge) {
    const int k = edge & 3;
    const int axis = edge >> 2;
    return axis == 0 ? k << 1 : axis == 1 ? (k & 1) | (k & 2) << 1 : k;
}

/// Three bits for each edge.
inline constexpr std::uint64_t edge_starts = [] {
    std::uint64_t starts = 0;
    for (int edge = 0; edge < 12; ++edge) starts |= static_cast<std::uint64_t>(edge_start(edge)) << (3 * edge);
    return starts;
}();

/// Writes the triangles of a cell of this stride from `out` on.
template <int stride>
MENISCUS_HD void emit_subcell_triangles(const BlocksView& blocks, std::uint32_t block, const CubeCase* table, Triangle* out) {
    const ClosedCell cell(blocks, block);
    const CellVertices vertices(blocks, cell);
    for_each_subcell(blocks, cell, stride, [&](int bit, int cube_case) {
        const CubeCase& pattern = table[cube_case];
        const int x = point_coordinate(bit, 0);
        const int y = point_coordinate(bit, 1);
        const int z = point_coordinate(bit, 2);
        for (int t = 0; t < pattern.triangles; ++t, ++out)
            for (int corner = 0; corner < 3; ++corner) {
                const int edge = pattern.edges[static_cast<std::size_t>(3 * t + corner)];
                const int start = static_cast<int>(edge_starts >> (3 * edge)) & 7;
                (*out)[static_cast<std::size_t>(corner)] = vertices.on_edge(
                    x + (start & 1) * stride, y + (start >> 1 & 1) * stride, z + (start >> 2) * stride, edge >> 2, stride);
            }
    });
}

/// Writes the triangles of a cell from `out` on.
MENISCUS_HD inline void emit_cell_triangles(const BlocksView& blocks, std::uint32_t block, const CubeCase* table, Triangle* out) {
    switch (blocks.level[block]) {
        case 1: return emit_subcell_triangles<4>(blocks, block, table, out);
        case 2: return emit_subcell_triangles<2>(blocks, block, table, out);
        default: return emit_subcell_triangles<1>(blocks, block, table, out);
    }
}

}  // namespace meniscus
