// Rules that raise the levels of some cells, applied where something near has changed since a rule last looked.
#pragma once

#include <atomic>
#include <cstdint>
#include <utility>

#include "backends/cpu/surface.hpp"

namespace meniscus::cpu {

/// Calls visit(number, bit) for the cells of a word.
template <class Visit>
void for_each_cell(const Brick& brick, int w, std::uint64_t cells, const Visit& visit) {
    for (std::uint64_t left = cells; left != 0; left &= left - 1) {
        const int bit = lowest_bit(left);
        visit(brick.number(64 * w + bit), bit);
    }
}

/// Calls visit(brick's number, w) for every word of every brick that has a member.
template <class Visit>
void for_each_word(Surface& s, const Visit& visit) {
    s.workers.for_ranges(s.grid.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b)
            for (int w = 0; w < Brick::words; ++w)
                if (s.grid.bricks[b].occupied[w] != 0) visit(static_cast<std::uint32_t>(b), w);
    });
}

/// Adds the cells of a word and the 26 around each of them to the stale cells of all rules.
void mark_stale_around(Surface& s, std::uint32_t brick, int w, std::uint64_t cells);

/// Takes a rule's stale cells out of a word.
inline std::uint64_t take_stale(Surface& s, StaleFor rule, std::uint32_t brick, int w) {
    return std::exchange(s.stale_cells(rule).word(brick, w), 0);
}

/// Raises the cells that raised(brick, w) gives for every word, all by the same state, to new_level(cell's number); returns whether there
/// were any.
template <class Raised, class NewLevel>
bool raise_levels(Surface& s, const Raised& raised, const NewLevel& new_level) {
    const CellSetView changes{s.grid.view(), s.raised.data()};
    std::atomic<bool> changed{false};
    for_each_word(s, [&](std::uint32_t brick, int w) {
        changes.word(brick, w) = raised(brick, w);
        if (changes.word(brick, w) != 0) changed.store(true, std::memory_order_relaxed);
    });
    if (!changed.load(std::memory_order_relaxed)) return false;
    const LevelSets levels = s.level_sets();
    for_each_word(s, [&](std::uint32_t brick, int w) {
        const std::uint64_t cells = changes.word(brick, w);
        if (cells == 0) return;
        for_each_cell(s.grid.bricks[brick], w, cells, [&](std::uint32_t block, int bit) {
            s.level[block] = static_cast<std::uint8_t>(new_level(block));
            for (int level = 1; level <= s.level[block]; ++level) levels.at_least[level].word(brick, w) |= std::uint64_t{1} << bit;
        });
        mark_stale_around(s, brick, w, cells);
    });
    return true;
}

}  // namespace meniscus::cpu
