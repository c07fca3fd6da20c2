// Step 3 on the CPU: rules look again only at cells near which a level has changed.
#include "steps/adjust_levels/adjust_levels.hpp"

#include "steps/adjust_levels/raise_levels.hpp"
#include "steps/cpu_steps.hpp"

namespace meniscus::cpu {

void collect_level_sets(State& state) {
    const std::size_t words = state.grid.bricks.size() * Brick::words;
    for (int level = 1; level <= 3; ++level) resize_for_overwrite(state.at_least[level], words);
    for (auto& set : state.stale) resize_for_overwrite(set, words);
    const LevelSets levels = state.level_sets();
    state.workers.for_ranges(state.grid.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b)
            for (int w = 0; w < Brick::words; ++w) {
                const auto brick = static_cast<std::uint32_t>(b);
                const WordLevels cells(state.grid.bricks[b], w, state.level.data());
                for (int level = 1; level <= 3; ++level) levels.at_least[level].word(brick, w) = cells.at_least[level];
                for (const StaleFor rule : all_rules)
                    state.stale_cells(rule).word(brick, w) = state.grid.bricks[b].occupied[w];
            }
    });
}

void mark_stale_around(State& state, std::uint32_t brick, int w, std::uint64_t cells) {
    const std::uint64_t along_x[3] = {cells << 15 & last_of_rows,
                                      cells | (cells << 1 & ~first_of_rows) | (cells >> 1 & ~last_of_rows),
                                      cells >> 15 & first_of_rows};
    for (int i = 0; i < neighbor_slots; ++i) {
        const auto [dx, dy, dz] = neighbor_offset(i);
        const std::uint64_t row = along_x[dx + 1];
        const std::uint64_t near = dy < 0 ? row << 48 : dy > 0 ? row >> 48 : row | row << 16 | row >> 16;
        if (near == 0) continue;
        const int y = (w & 3) + dy;
        const int z = (w >> 2) + dz;
        const std::uint32_t there = state.grid.neighbors[brick].brick[neighbor_slot(dx, y >> 2, z >> brick_axis_shift)];
        if (there == no_index) continue;
        const int word = (y & 3) | (z & brick_axis_mask) << 2;
        const std::uint64_t members = near & state.grid.bricks[there].occupied[word];
        for (const StaleFor rule : all_rules)
            std::atomic_ref(state.stale_cells(rule).word(there, word)).fetch_or(members, std::memory_order_relaxed);
    }
}

void adjust_levels(State& state) {
    const LevelSets levels = state.level_sets();
    const auto one_more = [&](std::uint32_t block) { return state.level[block] + 1; };
    const auto unbalanced = [&](std::uint32_t brick, int w) {
        return take_stale(state, StaleFor::balance, brick, w) == 0 ? 0 : unbalanced_cells(levels, brick, w);
    };
    const auto promoted = [&](std::uint32_t brick, int w) {
        return take_stale(state, StaleFor::promotion, brick, w) == 0 ? 0 : cells_to_promote(levels, brick, w);
    };
    state.now.step = SettlingTime::adjusting;
    for (;; ++state.now.step) {
        raise_levels(state, unbalanced, one_more);  // once suffices, see unbalanced_cells()
        ++state.now.step;
        if (!raise_levels(state, promoted, one_more)) return;
    }
}

}  // namespace meniscus::cpu
