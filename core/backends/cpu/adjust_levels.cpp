#include "stages/adjust_levels.hpp"

#include <algorithm>

#include "backends/cpu/level_sweep.hpp"
#include "backends/cpu/surface.hpp"

namespace meniscus::cpu {

void levels_are_new(Surface& s) {
    std::copy(s.level.begin(), s.level.end(), s.next_level.begin());
    std::fill(s.stale.begin(), s.stale.end(), all_rules);
}

void adjust_levels(Surface& s) {
    const auto balanced = [](const BlocksView& blocks, std::uint32_t b) { return blocks.level[b] == 0 ? 0 : balanced_level(blocks, b); };
    const auto promoted = [](const BlocksView& blocks, std::uint32_t b) { return blocks.level[b] == 0 ? 0 : promoted_level(blocks, b); };
    do {
        while (sweep_levels(s, balance_rule, balanced)) {}
    } while (sweep_levels(s, promotion_rule, promoted));
}

}  // namespace meniscus::cpu
