#include <algorithm>

#include "engine/cpu/surface.hpp"

namespace meniscus::cpu {

void cap_levels(Surface& s, const Array<std::uint8_t>& levels, int max_level) {
    const auto cap = static_cast<std::uint8_t>(max_level);
    s.workers.for_ranges(s.block_count(), 8192, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b) s.level[b] = std::min(levels[b], cap);
    });
    levels_are_new(s);
}

}  // namespace meniscus::cpu
