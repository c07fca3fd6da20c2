// Rules that raise the levels of some cells, applied where something near has changed since a rule last looked.
#pragma once

#include <atomic>
#include <cstdint>
#include <utility>

#include "engine/cpu/state.hpp"
#include "engine/cpu/words.hpp"
#include "steps/adjust_levels/adjust_levels.hpp"

namespace meniscus::cpu {

/// Adds the cells of a word and the 26 around each of them to the stale cells of all rules.
void mark_stale_around(State& state, std::uint32_t brick, int w, std::uint64_t cells);

/// Takes a rule's stale cells out of a word.
inline std::uint64_t take_stale(State& state, StaleFor rule, std::uint32_t brick, int w) {
    return std::exchange(state.stale_cells(rule).word(brick, w), 0);
}

/// Raises the cells that raised(brick, w) gives for every word, all by the same state, to new_level(cell's number);
/// returns whether there were any.
template <class Raised, class NewLevel>
bool raise_levels(State& state, const Raised& raised, const NewLevel& new_level) {
    const CellSetView changes = state.chosen_cells();
    std::atomic<bool> changed{false};
    for_each_word(state, [&](std::uint32_t brick, int w) {
        changes.word(brick, w) = raised(brick, w);
        if (changes.word(brick, w) != 0) changed.store(true, std::memory_order_relaxed);
    });
    if (!changed.load(std::memory_order_relaxed)) return false;
    const LevelSets levels = state.level_sets();
    const bool are_timed = !state.raise_times.empty();
    for_each_word(state, [&](std::uint32_t brick, int w) {
        const std::uint64_t cells = changes.word(brick, w);
        if (cells == 0) return;
        raise_cells(levels, state.level.data(), brick, w, cells, [&](std::uint32_t block) {
            const int level = new_level(block);
            if (are_timed) state.raise_times[block].note(state.level[block], level, state.now);
            return level;
        });
        mark_stale_around(state, brick, w, cells);
    });
    return true;
}

}  // namespace meniscus::cpu
