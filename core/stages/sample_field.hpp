// Step 4: which points of a block need a field value, and which cells the samples draw into the surface band.
#pragma once

#include <cstdint>

#include "lattice/host_device.hpp"
#include "stages/blocks.hpp"
#include "stages/place_vertices.hpp"

namespace meniscus {

/// The points of a block that the cells around it need as corners: all cells of the band whose closed box holds the point.
MENISCUS_HD inline BlockMask corner_points(const BlocksView& blocks, std::uint32_t block) {
    if (blocks.level[block] == 3) return ~BlockMask{0};
    BlockMask wanted = 0;
    for (int i = 0; i < 8; ++i) {
        const int level = blocks.level_or_none(blocks.neighbor(block, {-(i & 1), -(i >> 1 & 1), -(i >> 2)}));
        if (level == 0) continue;
        BlockMask shared = stride_points(level_stride(level));
        for (int axis = 0; axis < 3; ++axis)
            if (i >> axis & 1) shared &= low_face(axis);
        wanted |= shared;
    }
    return wanted;
}

/// The unsampled middles of coarse edges that cross the surface (design: an edge point lies on a finest lattice edge).
/// First with length 4, then, those being sampled, with length 2.
MENISCUS_HD inline BlockMask edge_middles(const BlocksView& blocks, std::uint32_t block, int length) {
    BlockMask wanted = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const CrossedEdges crossed(blocks, block, axis);
        wanted |= (length == 4 ? crossed.length4 << (2 * bit_step(axis)) : crossed.length2_all() << bit_step(axis));
    }
    return wanted & ~blocks.sampled[block];
}

/// The signs of the points, `stride` apart, of the face at the lower side of a base cell along an axis.
struct FaceSigns {
    bool any_inside = false;
    bool all_inside = true;

    MENISCUS_HD FaceSigns(const BlocksView& blocks, std::uint32_t upper, int axis, int stride) {
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        const BlockMask face = stride_points(stride) & low_face(axis);
        add(blocks.inside_or_none(upper), face);
        if (upper == no_index) return;
        add(blocks.inside_or_none(blocks.neighbor(upper, axis_offset(u))), face & low_face(u));
        add(blocks.inside_or_none(blocks.neighbor(upper, axis_offset(v))), face & low_face(v));
        add(blocks.inside_or_none(blocks.neighbor(upper, axis_offset(u) + axis_offset(v))), face & low_face(u) & low_face(v));
    }
    MENISCUS_HD bool mixed() const { return any_inside && !all_inside; }

private:
    MENISCUS_HD void add(BlockMask inside, BlockMask points) {
        any_inside |= (inside & points) != 0;
        all_inside &= (inside & points) == points;
    }
};

/// Whether a stored cell outside the band must join it: a neighbor in the band sees both signs on their common face, so that
/// skipping the cell would leave the mesh open.
MENISCUS_HD inline bool joins_band(const BlocksView& blocks, std::uint32_t block) {
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
            const std::uint32_t other = blocks.neighbor(block, axis_offset(axis, 2 * side - 1));
            const int level = blocks.level_or_none(other);
            if (level != 0 && FaceSigns(blocks, side == 1 ? other : block, axis, level_stride(level)).mixed()) return true;
        }
    return false;
}

/// Whether a finer neighbor sees surface on their common face where this cell's own corners show none: its part there would
/// end in a closed sliver at the face.
MENISCUS_HD inline bool misses_surface_on_face(const BlocksView& blocks, std::uint32_t block) {
    const int level = blocks.level[block];
    if (level == 0 || level == 3) return false;
    const int stride = level_stride(level);
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
            const std::uint32_t other = blocks.neighbor(block, axis_offset(axis, 2 * side - 1));
            if (blocks.level_or_none(other) <= level) continue;
            if (!FaceSigns(blocks, side == 1 ? other : block, axis, stride / 2).mixed()) continue;
            const ClosedCell cell(blocks, block);
            const int u = (axis + 1) % 3;
            const int v = (axis + 2) % 3;
            for (int cv = 0; cv < base_cell_size; cv += stride)
                for (int cu = 0; cu < base_cell_size; cu += stride) {
                    int inside = 0;
                    int corners = 0;
                    for (int i = 0; i < 9; ++i) {
                        int point[3];
                        point[axis] = side * base_cell_size;
                        point[u] = cu + i % 3 * stride / 2;
                        point[v] = cv + i / 3 * stride / 2;
                        const int in = static_cast<int>(cell.inside(blocks, point[0], point[1], point[2]));
                        inside += in;
                        if (i % 2 == 0 && i != 4) corners += in;
                    }
                    if ((corners == 0 && inside != 0) || (corners == 4 && inside != 9)) return true;
                }
        }
    return false;
}

/// The points of a block that lie strictly inside the domain [low, high], in cells.
MENISCUS_HD inline BlockMask domain_points(const Int3& base_cell, const Int3& low, const Int3& high) {
    const std::int32_t corner[3] = {base_cell.x * base_cell_size, base_cell.y * base_cell_size, base_cell.z * base_cell_size};
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
