// A coarser surface from the samples of a finer one.
#include <algorithm>

#include "steps/cpu_steps.hpp"

namespace meniscus::cpu {

void cap_levels(State& s, const Array<std::uint8_t>& levels, int max_level) {
    const auto cap = static_cast<std::uint8_t>(max_level);
    s.workers.for_ranges(s.block_count(), 8192, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b) s.level[b] = std::min(levels[b], cap);
    });
    collect_level_sets(s);
}

}  // namespace meniscus::cpu
