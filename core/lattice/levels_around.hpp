// The levels of the eight cells that share the points of a block: its own and those down the axes from it.
#pragma once

#include <cstdint>

#include "lattice/bits.hpp"
#include "lattice/blocks.hpp"
#include "lattice/host_device.hpp"
#include "lattice/lattice_part.hpp"
#include "lattice/level_sets.hpp"

namespace meniscus {

/// Sets of those cells as bits dx + 2 dy + 4 dz, d: steps down an axis.
struct LevelsAround {
    int at_least[5] = {};  ///< by level, 1 to 3: the cells of at least that level; 1: those in the surface band

    LevelsAround() = default;
    MENISCUS_HD LevelsAround(const BlocksView& blocks, std::uint32_t block)
        : LevelsAround(from([&](int i) { return blocks.level_or_none(blocks.neighbor(block, offset(i))); })) {}
    /// level_down(i): the level of the cell i steps down, 0 where there is none.
    template <class LevelDown>
    MENISCUS_HD static LevelsAround from(const LevelDown& level_down) {
        LevelsAround around;
        for (int i = 0; i < 8; ++i) {
            const int highest = level_down(i);
            for (int level = 1; level <= 3; ++level) around.at_least[level] |= (level <= highest ? 1 : 0) << i;
        }
        return around;
    }
    /// The same without the cells that are not a part's own. cell: the block's.
    MENISCUS_HD LevelsAround within(const LatticePart& part, const Int3& cell) const {
        LevelsAround around = *this;
        if (part.is_whole) return around;
        int own = 0;
        for (int i = 0; i < 8; ++i) own |= (part.owns(cell + offset(i)) ? 1 : 0) << i;
        for (int level = 1; level <= 3; ++level) around.at_least[level] &= own;
        return around;
    }
    MENISCUS_HD bool own_is_finest() const { return (at_least[3] & 1) != 0; }
    MENISCUS_HD static constexpr Int3 offset(int i) { return {-(i & 1), -(i >> 1 & 1), -(i >> 2)}; }
};

/// The same for the 64 blocks of a word.
class LevelSetsAround {
public:
    MENISCUS_HD LevelSetsAround(const LevelSets& levels, std::uint32_t brick, int w) {
        for (int i = 0; i < 8; ++i)
            sharing_ |= at_least_[0][i] = levels.at_least[1].moved(brick, w, LevelsAround::offset(i));
        if (sharing_ == 0) return;
        for (int level = 2; level <= 3; ++level)
            for (int i = 0; i < 8; ++i)
                at_least_[level - 1][i] = levels.at_least[level].moved(brick, w, LevelsAround::offset(i));
    }
    /// The places whose points a cell of the band has as corners.
    MENISCUS_HD std::uint64_t with_corner_points() const { return sharing_; }
    /// The levels around one of these.
    MENISCUS_HD LevelsAround operator()(int bit) const {
        LevelsAround around;
        for (int level = 1; level <= 3; ++level) around.at_least[level] = bits_across(at_least_[level - 1], bit);
        return around;
    }

private:
    std::uint64_t at_least_[3][8];
    std::uint64_t sharing_ = 0;
};

}  // namespace meniscus
