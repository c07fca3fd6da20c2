// Step 7: the triangles of a base cell, from the marching-cubes table. (The paper's Step 7, Algorithm 2;
// core/README.md#step-7-emit-triangles)
#pragma once

#include <cstdint>

#include "lattice/blocks.hpp"
#include "lattice/host_device.hpp"
#include "meniscus/mesh.hpp"
#include "steps/count_triangles/count_triangles.hpp"
#include "steps/place_vertices/place_vertices.hpp"
#include "steps/place_vertices/vertex_table.hpp"

namespace meniscus {

/// The vertices of a cell with subcells of this stride, found edge by edge.
struct SubcellVertices {
    const BlocksView& blocks;
    const ClosedCell& cell;
    int stride;

    /// The vertex on an edge (tables.hpp) of the subcell with this lower corner.
    MENISCUS_HD std::uint32_t operator()(int bit, int edge) const {
        const int start = edge_start(edge);
        return vertex_on_edge(blocks, cell, point_coordinate(bit, 0) + (start & 1) * stride,
                              point_coordinate(bit, 1) + (start >> 1 & 1) * stride,
                              point_coordinate(bit, 2) + (start >> 2) * stride, edge >> 2, stride);
    }
};

/// Writes the triangles of a cell from `out` on. vertex: from a subcell's lower corner and an edge to the vertex's
/// number.
template <class Vertices>
MENISCUS_HD inline void emit_subcell_triangles(const BlocksView& blocks, const ClosedCell& cell, int stride,
                                               const Vertices& vertex, const CubeCase* table, Triangle* out) {
    for_each_subcell(blocks, cell, stride, [&](int bit, int cube_case) {
        const CubeCase& pattern = table[cube_case];
        for (int t = 0; t < pattern.triangles; ++t, ++out)
            for (int corner = 0; corner < 3; ++corner)
                (*out)[static_cast<std::size_t>(corner)] =
                    vertex(bit, pattern.edges[static_cast<std::size_t>(3 * t + corner)]);
    });
}

/// Writes the triangles of a cell from `out` on.
MENISCUS_HD inline void emit_cell_triangles(const BlocksView& blocks, std::uint32_t block, const CubeCase* table,
                                            Triangle* out) {
    const ClosedCell cell(blocks, block);
    switch (blocks.level[block]) {
        case 1:
            return emit_subcell_triangles(blocks, cell, 4, SubcellVertices{blocks, cell, 4}, table, out);
        case 2:
            return emit_subcell_triangles(blocks, cell, 2, VertexTable<2>(blocks, cell), table, out);
        default:
            return emit_subcell_triangles(blocks, cell, 1, VertexTable<1>(blocks, cell), table, out);
    }
}

}  // namespace meniscus
