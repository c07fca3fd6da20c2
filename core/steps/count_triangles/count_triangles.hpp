// Step 5: the marching-cubes case of every subcell that the surface passes. (The paper's Step 5, Algorithm 2;
// core/README.md#step-5-count-triangles)
#pragma once

#include <cstdint>

#include "lattice/bits.hpp"
#include "lattice/blocks.hpp"
#include "lattice/host_device.hpp"
#include "lattice/tables/tables.hpp"

namespace meniscus {

/// For every point of a block as a subcell's lower corner: the signs of the subcell's eight corners (i = x + 2 y + 4
/// z).
struct SubcellCorners {
    BlockMask corner[8];

    MENISCUS_HD SubcellCorners(const BlocksView& blocks, const ClosedCell& cell, int stride) {
        for (int i = 0; i < 8; ++i) corner[i] = blocks.inside_or_none(cell.block[i]);
        move_to_corners(stride);
    }
    /// inside: the signs of the closed cell's eight blocks.
    MENISCUS_HD SubcellCorners(const BlockMask (&inside)[8], int stride) {
        for (int i = 0; i < 8; ++i) corner[i] = inside[i];
        move_to_corners(stride);
    }
    /// Subcells that see both signs.
    MENISCUS_HD BlockMask mixed(int stride) const {
        BlockMask any = 0;
        BlockMask all = ~BlockMask{0};
        for (const BlockMask c : corner) {
            any |= c;
            all &= c;
        }
        return any & ~all & stride_points(stride);
    }
    MENISCUS_HD int cube_case(int bit) const { return bits_across(corner, bit); }

private:
    /// Blocks become corners axis by axis: what lies one block further is moved to one stride further.
    MENISCUS_HD void move_to_corners(int stride) {
        for (int axis = 0; axis < 3; ++axis)
            for (int i = 0; i < 8; ++i)
                if ((i >> axis & 1) != 0) corner[i] = shifted(corner[i ^ (1 << axis)], corner[i], axis, stride);
    }
};

/// Calls visit(bit of the subcell's lower corner, cube case) for every subcell of a cell that the surface passes.
template <class Visit>
MENISCUS_HD void for_each_subcell(const BlocksView& blocks, const ClosedCell& cell, int stride, Visit&& visit) {
    const SubcellCorners corners(blocks, cell, stride);
    for (BlockMask left = corners.mixed(stride); left != 0; left &= left - 1) {
        const int bit = lowest_bit(left);
        visit(bit, corners.cube_case(bit));
    }
}

MENISCUS_HD inline std::uint32_t count_cell_triangles(const BlocksView& blocks, std::uint32_t block,
                                                      const CubeCase* table) {
    std::uint32_t count = 0;
    for_each_subcell(blocks, ClosedCell(blocks, block), level_stride(blocks.level[block]),
                     [&](int, int cube_case) { count += table[cube_case].triangles; });
    return count;
}

}  // namespace meniscus
