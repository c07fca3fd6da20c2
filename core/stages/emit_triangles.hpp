// Step 7: the triangles of a base cell, from the marching-cubes table.
#pragma once

#include <cstdint>

#include "lattice/host_device.hpp"
#include "meniscus/mesh.hpp"
#include "stages/blocks.hpp"
#include "stages/count_triangles.hpp"
#include "stages/place_vertices.hpp"

namespace meniscus {

/// Writes the triangles of a cell from `out` on.
MENISCUS_HD inline void emit_cell_triangles(const BlocksView& blocks, std::uint32_t block, const CubeCase* table, Triangle* out) {
    const ClosedCell cell(blocks, block);
    const int level = blocks.level[block];
    const int stride = level_stride(level);
    for_each_subcell(blocks, cell, level, [&](int bit, int cube_case) {
        const CubeCase& pattern = table[cube_case];
        for (int t = 0; t < pattern.triangles; ++t, ++out)
            for (int corner = 0; corner < 3; ++corner) {
                const int edge = pattern.edges[static_cast<std::size_t>(3 * t + corner)];
                const int axis = edge >> 2;
                const int first = axis == 0 ? 1 : 0;
                const int second = axis == 2 ? 1 : 2;
                int point[3] = {point_coordinate(bit, 0), point_coordinate(bit, 1), point_coordinate(bit, 2)};
                point[first] += (edge & 1) * stride;
                point[second] += (edge >> 1 & 1) * stride;
                (*out)[static_cast<std::size_t>(corner)] =
                    vertex_on_edge(blocks, cell, point[0], point[1], point[2], axis, stride);
            }
    });
}

}  // namespace meniscus
