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

/// Writes the triangles of one subcell from `out` on, and returns the end of them. bit: of its lower corner. vertex:
/// from that and an edge to the vertex's number.
template <class Vertices>
MENISCUS_HD inline Triangle* emit_subcell(const CubeCase& pattern, int bit, const Vertices& vertex, Triangle* out) {
    for (int t = 0; t < pattern.triangles; ++t, ++out)
        for (int corner = 0; corner < 3; ++corner)
            (*out)[static_cast<std::size_t>(corner)] =
                vertex(bit, pattern.edges[static_cast<std::size_t>(3 * t + corner)]);
    return out;
}

/// The same for all subcells of a cell.
template <class Vertices>
MENISCUS_HD inline Triangle* emit_subcell_triangles(const BlocksView& blocks, const ClosedCell& cell, int stride,
                                                    const Vertices& vertex, const CubeCase* table, Triangle* out) {
    for_each_subcell(blocks, cell, stride,
                     [&](int bit, int cube_case) { out = emit_subcell(table[cube_case], bit, vertex, out); });
    return out;
}

/// Writes the triangles of a cell from `out` on.
MENISCUS_HD inline void emit_cell_triangles(const BlocksView& blocks, std::uint32_t block, const CubeCase* table,
                                            Triangle* out) {
    const ClosedCell cell(blocks, block);
    switch (blocks.level[block]) {
        case 1:
            emit_subcell_triangles(blocks, cell, 4, SubcellVertices{blocks, cell, 4}, table, out);
            return;
        case 2:
            emit_subcell_triangles(blocks, cell, 2, VertexTable<2>(blocks, cell), table, out);
            return;
        default:
            emit_subcell_triangles(blocks, cell, 1, VertexTable<1>(blocks, cell), table, out);
            return;
    }
}

}  // namespace meniscus
