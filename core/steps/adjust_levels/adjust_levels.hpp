// Step 3: levels of face neighbors differ by at most one, and no lattice edge has fine and coarse cells in turn around
// it. Both bodies name the cells of a word that go up one level, by one state of all levels, so that the result does
// not depend on an order. (The paper's Step 3, Algorithm 1; why that suffices: core/README.md#closed-always)
#pragma once

#include <cstdint>

#include "lattice/host_device.hpp"
#include "lattice/level_sets.hpp"

namespace meniscus {

/// The cells of the band that lie two levels below a face neighbor: those of level 1 beside one of level 3. None goes
/// up to 3 for it, so that all words can be balanced once, in any order, and nothing is left to balance.
MENISCUS_HD inline std::uint64_t unbalanced_cells(const LevelSets& levels, std::uint32_t brick, int w) {
    const std::uint64_t coarsest = levels.band(brick, w) & ~levels.is_at_least(2, brick, w);
    return coarsest == 0 ? 0 : coarsest & levels.beside(3, brick, w);
}

/// A cell's edges along an axis at one side are a group: cells_to_promote looks at them together.
inline constexpr unsigned edge_groups = 6;

/// The coarse cells that, at one of their twelve edges, face another coarse cell across the edge with two cells between
/// them that are finer than both, and come first in the order (z, y, x): four crack fillings would share a chord there.
/// Only every sharers-th group of edges from `first` on is looked at.
template <unsigned sharers = 1>
MENISCUS_HD inline std::uint64_t cells_to_promote(const LevelSets& levels, std::uint32_t brick, int w,
                                                  unsigned first = 0) {
    const std::uint64_t coarse = levels.band(brick, w) & ~levels.is_at_least(3, brick, w);
    if (coarse == 0) return 0;
    const std::uint64_t own2 = levels.is_at_least(2, brick, w);
    std::uint64_t promoted = 0;
    for (unsigned group = first; group < edge_groups; group += sharers) {
        const int axis = static_cast<int>(group >> 1);
        const int side = (group & 1) != 0 ? 1 : -1;
        // The cell across comes later in (z, y, x) exactly if it lies up the later of the two axes, v.
        const Int3 along_v = axis_offset(lateral_v(axis), 1);
        const Int3 along_u = axis_offset(lateral_u(axis), side);
        const std::uint64_t finer2 =
            coarse & levels.at_least[2].moved(brick, w, along_v) & levels.at_least[2].moved(brick, w, along_u);
        if (finer2 == 0) continue;
        const std::uint64_t finer3 =
            finer2 & levels.at_least[3].moved(brick, w, along_v) & levels.at_least[3].moved(brick, w, along_u);
        const std::uint64_t across1 = levels.at_least[1].moved(brick, w, along_u + along_v);
        const std::uint64_t across2 = levels.at_least[2].moved(brick, w, along_u + along_v);
        const std::uint64_t across3 = levels.at_least[3].moved(brick, w, along_u + along_v);
        promoted |= across1 & ~across3 & ((finer2 & ~own2 & ~across2) | finer3);
    }
    return promoted;
}

/// Gives some cells of a word new_level(block), above the level that each has; the sets follow.
template <class NewLevel>
MENISCUS_HD inline void raise_cells(const LevelSets& levels, std::uint8_t* level, std::uint32_t brick, int w,
                                    std::uint64_t cells, const NewLevel& new_level) {
    const Brick& members = levels.at_least[1].grid.bricks[brick];
    std::uint64_t level2 = 0, level3 = 0;
    for (std::uint64_t left = cells; left != 0; left &= left - 1) {
        const std::uint64_t cell = left & (~left + 1);
        const std::uint32_t block = members.number(64 * w + lowest_bit(left));
        const int raised = new_level(block);
        level[block] = static_cast<std::uint8_t>(raised);
        if (raised >= 2) level2 |= cell;
        if (raised >= 3) level3 |= cell;
    }
    levels.at_least[1].word(brick, w) |= cells;
    if (level2 != 0) levels.at_least[2].word(brick, w) |= level2;
    if (level3 != 0) levels.at_least[3].word(brick, w) |= level3;
}

}  // namespace meniscus
