// Algorithm 3: the gaps on faces between cells of different levels, closed with predefined patterns. (The paper's
// Section 4; core/README.md#why-nine-signs)
#pragma once

#include <cstdint>

#include "lattice/blocks.hpp"
#include "lattice/face_signs.hpp"
#include "lattice/host_device.hpp"
#include "lattice/tables/tables.hpp"
#include "meniscus/mesh.hpp"
#include "steps/place_vertices/place_vertices.hpp"

namespace meniscus {

/// One coarse subface between a fine cell and its coarser neighbor.
struct CrackFace {
    int axis;       ///< normal to the face
    int side;       ///< 0: the coarse cell lies below the fine one, 1: above
    int stride;     ///< stride of the fine cell
    int corner[3];  ///< lowest point, in the fine cell's closed coordinates
};

/// The coarser cell beyond a face of a cell of the band; no_index where there is none. level: the cell's. side: 0: down
/// the axis, 1: up.
MENISCUS_HD inline std::uint32_t coarser_neighbor(const BlocksView& blocks, std::uint32_t block, int level, int axis,
                                                  int side) {
    const std::uint32_t other = blocks.neighbor(block, axis_offset(axis, 2 * side - 1));
    const int other_level = blocks.level_or_none(other);
    return other_level != 0 && other_level < level ? other : no_index;
}

/// Whether beyond a face of a cell of the band lies a coarser one.
MENISCUS_HD inline bool has_coarser_neighbor(const BlocksView& blocks, std::uint32_t block) {
    const int level = blocks.level[block];
    if (level == 1) return false;
    for (int face = 0; face < 6; ++face)
        if (coarser_neighbor(blocks, block, level, face >> 1, face & 1) != no_index) return true;
    return false;
}

/// Calls visit(face, crack case) for every subface of a fine cell that has a coarser neighbor beyond and sees both
/// signs.
template <class Visit>
MENISCUS_HD void for_each_crack(const BlocksView& blocks, std::uint32_t block, Visit&& visit) {
    const int level = blocks.level[block];
    if (level == 1) return;
    CrackFace face;
    face.stride = level_stride(level);
    for (face.axis = 0; face.axis < 3; ++face.axis)
        for (face.side = 0; face.side < 2; ++face.side) {
            const std::uint32_t other = coarser_neighbor(blocks, block, level, face.axis, face.side);
            if (other == no_index) continue;
            const FaceSigns signs(blocks, face.side == 1 ? other : block, face.axis, face.stride);
            for (BlockMask left = signs.mixed(); left != 0; left &= left - 1) {
                const int bit = lowest_bit(left);
                for (int axis = 0; axis < 3; ++axis)
                    face.corner[axis] = axis == face.axis ? face.side * base_cell_size : point_coordinate(bit, axis);
                visit(face, signs.pattern(bit));
            }
        }
}

MENISCUS_HD inline std::uint32_t count_crack_triangles(const BlocksView& blocks, std::uint32_t block,
                                                       const CrackCase* table) {
    std::uint32_t count = 0;
    for_each_crack(blocks, block, [&](const CrackFace&, int crack_case) { count += table[crack_case].triangles; });
    return count;
}

/// Writes the filling of one coarse subface from `out` on, and returns the end of it. cell: the fine cell's blocks.
MENISCUS_HD inline Triangle* emit_crack(const BlocksView& blocks, const ClosedCell& cell, const CrackFace& face,
                                        const CrackCase& pattern, Triangle* out) {
    for (int t = 0; t < pattern.triangles; ++t, ++out)
        for (int corner = 0; corner < 3; ++corner) {
            const int edge = pattern.edges[static_cast<std::size_t>(3 * t + corner)];
            const int u = (face.axis + 1) % 3;
            const int v = (face.axis + 2) % 3;
            const int along_u = (edge < 6 ? edge % 2 : (edge - 6) % 3) * face.stride;
            const int along_v = (edge < 6 ? edge / 2 : (edge - 6) / 3) * face.stride;
            // Asked for by constants alone: a GPU would keep an array that is not in its slow local memory.
            const auto point = [&](int axis) {
                return face.corner[axis] + (axis == u ? along_u : axis == v ? along_v : 0);
            };
            // The patterns are oriented for the fine cell lying up the axis.
            const int place = face.side == 0 ? corner : 2 - corner;
            (*out)[static_cast<std::size_t>(place)] =
                vertex_on_edge(blocks, cell, point(0), point(1), point(2), edge < 6 ? u : v, face.stride);
        }
    return out;
}

/// Writes the filling of a fine cell's faces from `out` on. cell: the block's.
MENISCUS_HD inline void emit_crack_triangles(const BlocksView& blocks, std::uint32_t block, const ClosedCell& cell,
                                             const CrackCase* table, Triangle* out) {
    for_each_crack(blocks, block, [&](const CrackFace& face, int crack_case) {
        out = emit_crack(blocks, cell, face, table[crack_case], out);
    });
}

}  // namespace meniscus
