// A coarser surface from the samples of a finer one.
#include <algorithm>

#include "steps/cpu_steps.hpp"

namespace meniscus::cpu {

void cap_levels(State& state, const Array<std::uint8_t>& levels, int max_level) {
    const auto cap = static_cast<std::uint8_t>(max_level);
    state.workers.for_ranges(state.block_count(), 8192, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b) state.level[b] = std::min(levels[b], cap);
    });
    collect_level_sets(state);
    if (!state.settings.part.is_whole) leave_other_bricks(state);
}

}  // namespace meniscus::cpu
