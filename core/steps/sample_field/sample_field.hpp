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

/// A base cell's faces: axis, and side 0 below, 1 above.
struct CellFace {
    int axis;
    int side;

    static constexpr unsigned count = 6;
    MENISCUS_HD constexpr explicit CellFace(unsigned i)
        : axis(static_cast<int>(i >> 1)), side(static_cast<int>(i & 1)) {}
    /// The offset of the cell on the other side.
    MENISCUS_HD constexpr Int3 offset() const { return axis_offset(axis, 2 * side - 1); }
};

/// Whether points `stride` apart on a cell's face show both signs.
MENISCUS_HD inline bool face_is_mixed(const BlocksView& blocks, std::uint32_t block, const CellFace& face, int stride) {
    const Int3 first = axis_offset(face.axis, face.side);
    const Int3 u = axis_offset((face.axis + 1) % 3);
    const Int3 v = axis_offset((face.axis + 2) % 3);
    const BlockMask low_u = low_face((face.axis + 1) % 3);
    const BlockMask low_v = low_face((face.axis + 2) % 3);
    const BlockMask points = stride_points(stride) & low_face(face.axis);
    const BlockMask own = blocks.inside_or_none(blocks.neighbor(block, first)) & points;
    if (own != 0 && own != points) return true;
    const auto differs = [&](const Int3& offset, BlockMask some) {
        return ((blocks.inside_or_none(blocks.neighbor(block, first + offset)) ^ own) & some) != 0;
    };
    return differs(u, points & low_u) || differs(v, points & low_v) || differs(u + v, points & low_u & low_v);
}

/// Whether a stored cell outside the band must join it for a face: its neighbor there is in the band and sees both
/// signs on the face, so that skipping the cell would leave the mesh open.
MENISCUS_HD inline bool joins_band(const BlocksView& blocks, std::uint32_t block, const CellFace& face) {
    const int level = blocks.level_or_none(blocks.neighbor(block, face.offset()));
    return level != 0 && face_is_mixed(blocks, block, face, level_stride(level));
}

/// The cells of the band with a finer face neighbor.
MENISCUS_HD inline std::uint64_t cells_beside_finer(const LevelSets& levels, std::uint32_t brick, int w) {
    const std::uint64_t coarse = levels.band(brick, w) & ~levels.is_at_least(3, brick, w);
    if (coarse == 0) return 0;
    const std::uint64_t level2 = levels.is_at_least(2, brick, w);
    return (coarse & ~level2 & levels.beside(2, brick, w)) | (coarse & level2 & levels.beside(3, brick, w));
}

/// Whether a finer neighbor of a cell of the band sees surface on their common face where this cell's own corners show
/// none: its part there would end in a closed sliver at the face. Cells that have just joined the band are not sampled
/// yet: what they would see is found out in the next round.
MENISCUS_HD inline bool misses_surface(const BlocksView& blocks, std::uint32_t block, const CellFace& face) {
    const int level = blocks.level[block];
    const std::uint32_t other = blocks.neighbor(block, face.offset());
    if (blocks.level_or_none(other) <= level) return false;
    const std::uint32_t upper = face.side == 1 ? other : block;
    const int stride = level_stride(level) / 2;
    const FaceSigns signs(blocks, upper, face.axis, stride);
    return signs.hiding() != 0 && signs.hiding(FaceSigns::possible(blocks, upper, face.axis, stride)) != 0;
}

/// Whether a rule, one of the two above, holds for any face of a cell.
template <class Rule>
MENISCUS_HD inline bool holds_at_a_face(const Rule& rule, const BlocksView& blocks, std::uint32_t block) {
    for (unsigned i = 0; i < CellFace::count; ++i)
        if (rule(blocks, block, CellFace(i))) return true;
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
