#include "stages/adjust_levels.hpp"

#include <atomic>

#include "backends/cpu/surface.hpp"

namespace meniscus::cpu {
namespace {

/// One sweep from one state of all levels to the next; returns whether anything changed.
template <class Body>
bool sweep(Surface& s, const Body& body) {
    const BlocksView blocks = s.view();
    std::atomic<bool> changed{false};
    s.workers.for_ranges(s.block_count(), 4096, [&](std::size_t begin, std::size_t end, unsigned) {
        bool here = false;
        for (std::size_t b = begin; b < end; ++b) {
            const auto block = static_cast<std::uint32_t>(b);
            const int level = blocks.level[block];
            const int next = level == 0 ? 0 : body(blocks, block);
            s.next_level[b] = static_cast<std::uint8_t>(next);
            here |= next != level;
        }
        if (here) changed.store(true, std::memory_order_relaxed);
    });
    s.level.swap(s.next_level);
    return changed.load(std::memory_order_relaxed);
}

}  // namespace

void adjust_levels(Surface& s) {
    do {
        while (sweep(s, balanced_level)) {}
    } while (sweep(s, promoted_level));
}

}  // namespace meniscus::cpu
