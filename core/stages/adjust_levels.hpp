// Step 3: levels of face neighbors differ by at most one, and no lattice edge has fine and coarse cells in turn around it.
// Both bodies map one state of all levels to the next, so that the result does not depend on an order.
#pragma once

#include <cstdint>

#include "lattice/host_device.hpp"
#include "stages/blocks.hpp"

namespace meniscus {

/// The level of a cell of the band, at least its face neighbors' less one.
MENISCUS_HD inline int balanced_level(const BlocksView& blocks, std::uint32_t block) {
    int level = blocks.level[block];
    if (level == 3) return level;
    for (int axis = 0; axis < 3; ++axis)
        for (int side = -1; side <= 1; side += 2) {
            const int needed = blocks.level_or_none(blocks.neighbor(block, axis_offset(axis, side))) - 1;
            if (needed > level) level = needed;
        }
    return level;
}

/// One more than the level of a coarse cell that, at one of its twelve edges, faces another coarse cell across the edge
/// with two finer ones between them, and comes first in the order (z, y, x): four crack fillings would share a chord there.
MENISCUS_HD inline int promoted_level(const BlocksView& blocks, std::uint32_t block) {
    const int level = blocks.level[block];
    if (level == 3) return level;
    bool finer[3][2];
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side)
            finer[axis][side] = blocks.level_or_none(blocks.neighbor(block, axis_offset(axis, 2 * side - 1))) > level;
    for (int axis = 0; axis < 3; ++axis) {
        const int u = axis == 0 ? 1 : 0;
        const int v = axis == 2 ? 1 : 2;
        // The cell across comes later in (z, y, x) exactly if it lies up the later of the two axes, v.
        for (int side = 0; side < 2; ++side) {
            if (!finer[u][side] || !finer[v][1]) continue;
            const Int3 along_u = axis_offset(u, 2 * side - 1);
            const Int3 along_v = axis_offset(v, 1);
            const int across = blocks.level_or_none(blocks.neighbor(block, along_u + along_v));
            if (across != 0 && blocks.level_or_none(blocks.neighbor(block, along_u)) > across &&
                blocks.level_or_none(blocks.neighbor(block, along_v)) > across)
                return level + 1;
        }
    }
    return level;
}

}  // namespace meniscus
