// The levels of all base cells as sets, for rules that look at 64 cells at once.
#pragma once

#include <cstdint>

#include "lattice/blocks.hpp"
#include "lattice/cell_set.hpp"
#include "lattice/host_device.hpp"

namespace meniscus {

struct LevelSets {
    CellSetView at_least[4];  ///< by level, 1 to 3: the cells of at least that level; 1: the surface band

    MENISCUS_HD std::uint64_t band(std::uint32_t brick, int w) const { return at_least[1].word(brick, w); }
    MENISCUS_HD std::uint64_t is_at_least(int level, std::uint32_t brick, int w) const {
        return at_least[level].word(brick, w);
    }
    /// Cells with a face neighbor of at least this level.
    MENISCUS_HD std::uint64_t beside(int level, std::uint32_t brick, int w) const {
        std::uint64_t cells = 0;
        for (int axis = 0; axis < 3; ++axis)
            for (int side = -1; side <= 1; side += 2) cells |= at_least[level].moved(brick, w, axis_offset(axis, side));
        return cells;
    }
    /// Cells with a neighbor of a higher level at an offset.
    MENISCUS_HD std::uint64_t below(std::uint32_t brick, int w, const Int3& offset) const {
        std::uint64_t cells = 0;
        std::uint64_t reaching = ~std::uint64_t{0};  // the level before
        for (int level = 1; level <= 3; ++level) {
            const std::uint64_t own = is_at_least(level, brick, w);
            cells |= reaching & ~own & at_least[level].moved(brick, w, offset);
            reaching = own;
        }
        return cells;
    }
};

/// The cells of a word of Brick::occupied that are of at least each level, 1 to 3.
struct WordLevels {
    std::uint64_t at_least[4] = {};

    /// level: of every block.
    MENISCUS_HD WordLevels(const Brick& brick, int w, const std::uint8_t* level) {
        std::uint32_t block = brick.first + brick.rank[w];
        for (std::uint64_t left = brick.occupied[w]; left != 0; left &= left - 1, ++block) {
            const std::uint64_t cell = left & (~left + 1);
            if (level[block] >= 1) at_least[1] |= cell;
            if (level[block] >= 2) at_least[2] |= cell;
            if (level[block] >= 3) at_least[3] |= cell;
        }
    }
};

}  // namespace meniscus
