// After the last step: the part of the lattice that the cells of one brick make their triangles of, for the codec that
// sends it in their place. (core/README.md#the-lattice-codec)
#pragma once

#include <array>
#include <cstdint>

#include "lattice/blocks.hpp"
#include "lattice/closed_brick.hpp"
#include "lattice/host_device.hpp"
#include "lattice/levels_around.hpp"
#include "steps/count_triangles/count_triangles.hpp"
#include "steps/fill_cracks/fill_cracks.hpp"
#include "steps/place_vertices/place_vertices.hpp"
#include "steps/sample_field/sample_field.hpp"

namespace meniscus {

/// Whether a cell of the band sees both signs.
MENISCUS_HD inline bool draws(const BlocksView& blocks, const ClosedCell& cell, int level) {
    const int stride = level_stride(level);
    return SubcellCorners(blocks, cell, stride).mixed(stride) != 0;
}

/// The place of a brick's own cell.
MENISCUS_HD inline int closed_place_of(std::uint16_t index) {
    const Int3 at = place_in_brick(index);
    return closed_place(at.x, at.y, at.z);
}

/// Whether a face of a cell, 2 axis + side, lies on its brick's.
MENISCUS_HD inline bool is_outer_face(const Int3& in_brick, int face) {
    const int coordinate = face < 2 ? in_brick.x : face < 4 ? in_brick.y : in_brick.z;
    return coordinate == (face & 1) * (brick_size - 1);
}

/// The faces of a cell on those of its brick beyond which a coarser cell lies, as bits 2 axis + side.
MENISCUS_HD inline unsigned coarser_beyond_brick(const BlocksView& blocks, std::uint32_t block, int level) {
    if (level == 1) return 0;
    const Int3 at = place_in_brick(blocks.place[block]);
    unsigned faces = 0;
    for (int face = 0; face < 6; ++face)
        if (is_outer_face(at, face) && coarser_neighbor(blocks, block, level, face >> 1, face & 1) != no_index)
            faces |= 1U << face;
    return faces;
}

/// The result of find_brick_edges() for a block.
struct BrickEdges {
    BlockMask& inside;    ///< signs of the corners; those of middles and quarters are added
    BlockMask& middles;   ///< middles of crossed coarse edges that are no corners
    BlockMask& quarters;  ///< middles of the halves of those, which are neither
    EdgeMasks& edges;     ///< finest edges that carry a vertex
};

/// The same where edges of level 1 are the only ones: they start at the block's first point.
template <class LookUp>
MENISCUS_HD void find_level1_edges(const LevelsAround& levels, const BlockMask (&next)[3], const LookUp& look_up,
                                   const BrickEdges& block) {
    BlockMask halving = 0;
    for (int axis = 0; axis < 3; ++axis)
        if ((used_edges(levels, axis, 1) & (block.inside ^ next[axis])) != 0) halving |= level1_middle(axis);
    if (halving == 0) return;
    look_up(halving, block.middles);
    look_up(half_edge_middles(block.inside, halving), block.quarters);
    const BlockMask signs = block.inside;
    for (int axis = 0; axis < 3; ++axis) {
        if ((halving & level1_middle(axis)) == 0) continue;
        const int step = bit_step(axis);
        const int half = ((signs ^ signs >> 2 * step) & 1) != 0 ? 0 : 2 * step;
        const int finest = ((signs >> half ^ signs >> (half + step)) & 1) != 0 ? half : half + step;
        block.edges.axis[axis] = BlockMask{1} << finest;
    }
}

/// Finds a block's finest edges that carry a vertex for cells of one brick, of which all but `inside` are zero before.
/// levels: of the brick's cells that draw. corners: the points that these have as corners. next: signs of the blocks up
/// the axes, of which the brick's corners alone count. middle(points): the signs of these points, middles of crossed
/// coarse edges that are no corners.
template <class Middle>
MENISCUS_HD void find_brick_edges(const LevelsAround& levels, BlockMask corners, const BlockMask (&next)[3],
                                  const Middle& middle, const BrickEdges& block) {
    const BlockMask own = block.inside;
    const bool is_crossed = next[0] != own || next[1] != own || next[2] != own;
    if (!is_crossed && (own == 0 || own == ~BlockMask{0})) return;
    if (levels.own_is_finest()) {
        for (int axis = 0; axis < 3; ++axis) block.edges.axis[axis] = own ^ shifted(own, next[axis], axis, 1);
        return;
    }
    const auto look_up = [&](BlockMask points, BlockMask& of_kind) {
        points &= ~(corners | block.middles | block.quarters);
        if (points == 0) return;
        of_kind |= points;
        block.inside |= middle(points);
    };
    if (levels.at_least[2] == 0) {
        find_level1_edges(levels, next, look_up, block);
        return;
    }
    CrossedEdges crossed[3] = {{own, next[0], levels, 0}, {own, next[1], levels, 1}, {own, next[2], levels, 2}};
    BlockMask halving = 0;
    BlockMask longest = 0;
    for (int axis = 0; axis < 3; ++axis) {
        halving |= crossed[axis].length4 << 2 * bit_step(axis) | crossed[axis].length2 << bit_step(axis);
        longest |= crossed[axis].length4 << 2 * bit_step(axis);
    }
    look_up(halving, block.middles);
    look_up(half_edge_middles(block.inside, longest), block.quarters);
    for (int axis = 0; axis < 3; ++axis) {
        crossed[axis].look_at(block.inside, next[axis]);
        block.edges.axis[axis] = crossed[axis].finest();
    }
}

/// Calls visit(axis, number in the mesh) for the vertices that a brick's cells have in a block, by axis, then by bit. A
/// neighboring brick may have more there. all, first_vertex: of LatticeBlock. own: the brick's edges.
template <class Visit>
MENISCUS_HD void for_each_brick_vertex(const std::array<BlockMask, 3>& all, std::uint32_t first_vertex,
                                       const EdgeMasks& own, const Visit& visit) {
    for (int axis = 0; axis < 3; ++axis) {
        const BlockMask of_mesh = all[static_cast<std::size_t>(axis)];
        for (BlockMask left = own.axis[axis]; left != 0; left &= left - 1) {
            const BlockMask before = (left & (~left + 1)) - 1;
            visit(axis, first_vertex + static_cast<std::uint32_t>(popcount(of_mesh & before)));
        }
        first_vertex += static_cast<std::uint32_t>(popcount(of_mesh));
    }
}

/// A vertex of a brick.
struct BrickVertex {
    int axis;
    std::uint32_t number;  ///< in the mesh
};
/// The n-th of for_each_brick_vertex(), n from 0; there are more than n.
MENISCUS_HD inline BrickVertex nth_brick_vertex(const std::array<BlockMask, 3>& all, std::uint32_t first_vertex,
                                                const EdgeMasks& own, std::uint32_t n) {
    int axis = 0;
    for (; axis < 2; ++axis) {
        const auto of_axis = static_cast<std::uint32_t>(popcount(own.axis[axis]));
        if (n < of_axis) break;
        n -= of_axis;
        first_vertex += static_cast<std::uint32_t>(popcount(all[static_cast<std::size_t>(axis)]));
    }
    const BlockMask before = (BlockMask{1} << nth_bit(own.axis[axis], static_cast<int>(n))) - 1;
    return {axis, first_vertex + static_cast<std::uint32_t>(popcount(all[static_cast<std::size_t>(axis)] & before))};
}

}  // namespace meniscus
