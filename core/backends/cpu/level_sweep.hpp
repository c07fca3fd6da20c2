// Rules that map all levels to new ones, applied only where something near has changed since a rule last looked.
//
// A rule reads the state of a block and of the 26 around it. Where none of these has changed, neither does its answer, so
// that skipping such blocks gives what a sweep over all would.
#pragma once

#include <atomic>
#include <cstdint>

#include "backends/cpu/surface.hpp"

namespace meniscus::cpu {

/// Bits of Surface::stale: the rules that must look at a block again.
enum Rule : std::uint8_t { balance_rule = 1, promotion_rule = 2, corner_rule = 4, band_rule = 8, sliver_rule = 16 };
inline constexpr std::uint8_t all_rules = 31;

/// Takes a rule's bit from a block; returns whether it was there.
inline bool take_stale(Surface& s, std::size_t block, Rule rule) {
    std::uint8_t& bits = s.stale[block];
    if ((bits & rule) == 0) return false;
    bits = static_cast<std::uint8_t>(bits & ~rule);
    return true;
}

/// One sweep from one state of all levels to the next; returns whether anything changed.
template <class NewLevel>
bool sweep_levels(Surface& s, Rule rule, const NewLevel& new_level) {
    const BlocksView blocks = s.view();
    std::atomic<bool> changed{false};
    s.workers.for_ranges(s.block_count(), 4096, [&](std::size_t begin, std::size_t end, unsigned) {
        bool here = false;
        for (std::size_t b = begin; b < end; ++b) {
            if (!take_stale(s, b, rule)) continue;
            s.next_level[b] = static_cast<std::uint8_t>(new_level(blocks, static_cast<std::uint32_t>(b)));
            here |= s.next_level[b] != blocks.level[b];
        }
        if (here) changed.store(true, std::memory_order_relaxed);
    });
    if (!changed.load(std::memory_order_relaxed)) return false;
    s.workers.for_ranges(s.block_count(), 4096, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t b = begin; b < end; ++b) {
            if (s.next_level[b] == s.level[b]) continue;
            s.level[b] = s.next_level[b];
            for (int i = 0; i < 27; ++i) {
                const std::uint32_t near = blocks.neighbor(static_cast<std::uint32_t>(b), {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1});
                if (near != no_index) std::atomic_ref(s.stale[near]).fetch_or(all_rules, std::memory_order_relaxed);
            }
        }
    });
    return true;
}

}  // namespace meniscus::cpu
