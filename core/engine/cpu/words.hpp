// Passes over the stored base cells by words of a brick, and over some of a word's cells.
#pragma once

#include <cstdint>

#include "engine/cpu/state.hpp"

namespace meniscus::cpu {

/// Calls visit(number, bit) for the cells of a word.
template <class Visit>
void for_each_cell(const Brick& brick, int w, std::uint64_t cells, const Visit& visit) {
    for (std::uint64_t left = cells; left != 0; left &= left - 1) {
        const int bit = lowest_bit(left);
        visit(brick.number(64 * w + bit), bit);
    }
}

/// Calls visit(w) for every word of a brick that has a member.
template <class Visit>
void for_each_word(const Brick& brick, const Visit& visit) {
    for (int w = 0; w < Brick::words; ++w)
        if (brick.occupied[w] != 0) visit(w);
}

/// Calls visit(number) for every brick, in parallel.
template <class Visit>
void for_each_brick(State& state, const Visit& visit) {
    state.workers.for_ranges(state.grid.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b) visit(static_cast<std::uint32_t>(b));
    });
}

/// Calls visit(brick's number, w) for every word of every brick that has a member.
template <class Visit>
void for_each_word(State& state, const Visit& visit) {
    for_each_brick(
        state, [&](std::uint32_t brick) { for_each_word(state.grid.bricks[brick], [&](int w) { visit(brick, w); }); });
}

/// Replaces every count by the sum of those before it; returns the sum of all.
inline std::uint64_t counts_to_starts(Array<std::uint64_t>& counts) {
    std::uint64_t total = 0;
    for (std::uint64_t& count : counts) {
        const std::uint64_t own = count;
        count = total;
        total += own;
    }
    return total;
}

}  // namespace meniscus::cpu
