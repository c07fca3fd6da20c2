// A base cell's block of 4 x 4 x 4 lattice points as a 64-bit mask: point (x, y, z) is bit x + 4 y + 16 z.
#pragma once

#include <cstdint>

#include "lattice/coordinates.hpp"
#include "lattice/host_device.hpp"

namespace meniscus {

using BlockMask = std::uint64_t;

/// The distance of two bits one point apart along an axis (0 x, 1 y, 2 z).
MENISCUS_HD constexpr int bit_step(int axis) {
    return axis == 0 ? 1 : axis == 1 ? 4 : 16;
}

// The other two axes, in ascending order.
MENISCUS_HD constexpr int lateral_u(int axis) {
    return axis == 0 ? 1 : 0;
}
MENISCUS_HD constexpr int lateral_v(int axis) {
    return axis == 2 ? 1 : 2;
}

MENISCUS_HD constexpr int point_bit(int x, int y, int z) {
    return x + 4 * y + 16 * z;
}
MENISCUS_HD constexpr int point_coordinate(int bit, int axis) {
    return (bit >> (2 * axis)) & 3;
}

/// The points whose coordinate along the axis is 0.
MENISCUS_HD constexpr BlockMask low_face(int axis) {
    return axis == 0 ? 0x1111111111111111ULL : axis == 1 ? 0x000F000F000F000FULL : 0x000000000000FFFFULL;
}

/// The coordinates along an axis that any of the points have, as bits 0 to 3.
MENISCUS_HD constexpr unsigned occupied_slabs(BlockMask points, int axis) {
    unsigned slabs = 0;
    for (int i = 0; i < base_cell_size; ++i)
        slabs |= static_cast<unsigned>((points & low_face(axis) << (i * bit_step(axis))) != 0) << i;
    return slabs;
}

/// Edge of a level's subcell in finest cells: 4, 2, 1 for levels 1, 2, 3.
MENISCUS_HD constexpr int level_stride(int level) {
    return 8 >> level;
}

/// The points that a cell of this stride owns: all coordinates divisible by it.
MENISCUS_HD constexpr BlockMask stride_points(int stride) {
    return stride == 1 ? ~BlockMask{0} : stride == 2 ? 0x0000050500000505ULL : BlockMask{1};
}

/// For every point p, the value of `own` at p + distance along the axis; `next` is the neighbor block on that side.
MENISCUS_HD constexpr BlockMask shifted(BlockMask own, BlockMask next, int axis, int distance) {
    if (distance <= 0) return own;
    if (distance >= 4) return next;
    // The points whose coordinate is below 4 - distance keep their own block's values.
    BlockMask keep = low_face(axis);
    if (distance <= 2) keep |= low_face(axis) << bit_step(axis);
    if (distance <= 1) keep |= low_face(axis) << (2 * bit_step(axis));
    const int low = distance * bit_step(axis);
    const int high = (4 - distance) * bit_step(axis);
    return ((own >> low) & keep) | ((next << high) & ~keep);
}

}  // namespace meniscus
