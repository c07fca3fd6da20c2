// Step 4: which points of a block need a field value, and which cells the samples draw into the surface band. (The
// paper's Step 4, Algorithm 2; core/README.md#step-4-sample-field)
#pragma once

#include <cstdint>

#include "lattice/blocks.hpp"
#include "lattice/face_signs.hpp"
#include "lattice/host_device.hpp"
#include "lattice/level_sets.hpp"
#include "lattice/levels_around.hpp"
#include "steps/place_vertices/place_vertices.hpp"

namespace meniscus {

/// The points of a block that the cells around it need as corners: all cells of the band whose closed box holds the
/// point.
MENISCUS_HD inline BlockMask corner_points(const LevelsAround& around) {
    if (around.own_is_finest()) return ~BlockMask{0};
    BlockMask wanted = around.at_least[1] != 0 ? stride_points(level_stride(1)) : 0;
    for (std::uint64_t left = static_cast<unsigned>(around.at_least[2]); left != 0; left &= left - 1) {
        const int i = lowest_bit(left);
        BlockMask shared = stride_points(level_stride((around.at_least[3] >> i & 1) != 0 ? 3 : 2));
        for (int axis = 0; axis < 3; ++axis)
            if ((i >> axis & 1) != 0) shared &= low_face(axis);
        wanted |= shared;
    }
    return wanted;
}

/// The unsampled middles of coarse edges that cross the surface: an edge point lies on a finest lattice edge
/// (core/README.md#step-6-place-vertices).
MENISCUS_HD inline BlockMask edge_middles(const BlocksView& blocks, std::uint32_t block, const LevelsAround& around) {
    BlockMask wanted = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const CrossedEdges crossed(blocks, block, around, axis);
        wanted |= crossed.length4 << (2 * bit_step(axis)) | crossed.length2 << bit_step(axis);
    }
    return wanted & ~blocks.sampled[block];
}

/// The middle of the level-1 edge that starts at a block along an axis.
MENISCUS_HD constexpr BlockMask level1_middle(int axis) {
    return BlockMask{1} << 2 * bit_step(axis);
}
inline constexpr BlockMask level1_middles = level1_middle(0) | level1_middle(1) | level1_middle(2);

/// Once the middles of crossing level-1 edges are sampled: the middles of those halves that cross the surface.
/// inside: a block's points inside the fluid. middles: of its crossing edges.
MENISCUS_HD inline BlockMask half_edge_middles(BlockMask inside, BlockMask middles) {
    BlockMask wanted = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if ((middles & level1_middle(axis)) == 0) continue;
        const bool lower = ((inside ^ inside >> 2 * bit_step(axis)) & 1) != 0;
        wanted |= BlockMask{1} << (lower ? 1 : 3) * bit_step(axis);
    }
    return wanted;
}

/// Whether a cell's points `stride` apart on its face at one side (0 below, 1 above) along an axis show both signs.
MENISCUS_HD inline bool face_is_mixed(const BlocksView& blocks, const ClosedCell& cell, int axis, int side,
                                      int stride) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const int first = side << axis;
    const BlockMask face = stride_points(stride) & low_face(axis);
    const BlockMask own = blocks.inside_or_none(cell.block[first]) & face;
    if (own != 0 && own != face) return true;
    const auto differs = [&](int i, BlockMask points) {
        return ((blocks.inside_or_none(cell.block[first | i]) ^ own) & points) != 0;
    };
    return differs(1 << u, face & low_face(u)) || differs(1 << v, face & low_face(v)) ||
           differs(1 << u | 1 << v, face & low_face(u) & low_face(v));
}

/// Whether a stored cell outside the band must join it: a neighbor in the band sees both signs on their common face, so
/// that skipping the cell would leave the mesh open.
MENISCUS_HD inline bool joins_band(const BlocksView& blocks, std::uint32_t block) {
    const ClosedCell cell(blocks, block);
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
            const int level =
                blocks.level_or_none(side == 1 ? cell.block[1 << axis] : blocks.neighbor(block, axis_offset(axis, -1)));
            if (level != 0 && face_is_mixed(blocks, cell, axis, side, level_stride(level))) return true;
        }
    return false;
}

/// The cells of the band with a finer face neighbor.
MENISCUS_HD inline std::uint64_t cells_beside_finer(const LevelSets& levels, std::uint32_t brick, int w) {
    const std::uint64_t coarse = levels.band(brick, w) & ~levels.is_at_least(3, brick, w);
    if (coarse == 0) return 0;
    const std::uint64_t level2 = levels.is_at_least(2, brick, w);
    return (coarse & ~level2 & levels.beside(2, brick, w)) | (coarse & level2 & levels.beside(3, brick, w));
}

/// Whether a finer neighbor sees surface on their common face where this cell's own corners show none: its part there
/// would end in a closed sliver at the face.
MENISCUS_HD inline bool misses_surface_on_face(const BlocksView& blocks, std::uint32_t block) {
    const int level = blocks.level[block];
    if (level == 0 || level == 3) return false;
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
            const std::uint32_t other = blocks.neighbor(block, axis_offset(axis, 2 * side - 1));
            if (blocks.level_or_none(other) > level &&
                FaceSigns(blocks, side == 1 ? other : block, axis, level_stride(level) / 2).hiding() != 0)
                return true;
        }
    return false;
}

/// The points of a block that lie strictly inside the domain [low, high], in cells.
MENISCUS_HD inline BlockMask domain_points(const Int3& base_cell, const Int3& low, const Int3& high) {
    const std::int32_t corner[3] = {base_cell.x * base_cell_size, base_cell.y * base_cell_size,
                                    base_cell.z * base_cell_size};
    const std::int32_t lows[3] = {low.x, low.y, low.z};
    const std::int32_t highs[3] = {high.x, high.y, high.z};
    BlockMask points = ~BlockMask{0};
    for (int axis = 0; axis < 3; ++axis) {
        BlockMask slabs = 0;
        for (int i = 0; i < base_cell_size; ++i)
            if (corner[axis] + i > lows[axis] && corner[axis] + i < highs[axis])
                slabs |= low_face(axis) << (i * bit_step(axis));
        points &= slabs;
    }
    return points;
}

}  // namespace meniscus
