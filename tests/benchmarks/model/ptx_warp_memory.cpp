// A warp's use of memory: bytes, and counts of the accesses that a GPU would make for them.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <stdexcept>
#include <string>

#include "model/ptx_codes.hpp"
#include "model/ptx_warp.hpp"

namespace meniscus::benchmarks {

std::byte* PtxWarp::address(const PtxInstruction& i, unsigned lane) {
    const std::uint64_t base = values(i.from[0])[lane];
    if (i.space == PtxSpace::shared) {
        const std::uint64_t at = static_cast<std::uint32_t>(base) + static_cast<std::uint64_t>(i.offset);
        if (at + std::uint64_t{i.element_bytes} * i.elements > block->shared.size())
            throw std::runtime_error("shared memory is overrun: " + program_.kernel().name);
        return block->shared.data() + at;
    }
    const std::uint64_t at = base + static_cast<std::uint64_t>(i.offset);
    return reinterpret_cast<std::byte*>(at);  // NOLINT(performance-no-int-to-ptr): PTX has addresses in registers
}

/// Counts what an access asks memory for; returns the cycles until a load has it.
double PtxWarp::access(const PtxInstruction& i, std::uint32_t mask) {
    LaunchCounts& counts = grid_.counts;
    const std::uint64_t bytes = std::uint64_t{i.element_bytes} * i.elements;
    if (i.space == PtxSpace::parameter) return 0.0;
    if (i.space == PtxSpace::shared) {
        // Different words of one bank come one after another.
        std::array<std::uint64_t, warp_lanes> words{};
        unsigned count = 0;
        for (std::uint32_t left = mask; left != 0; left &= left - 1) {
            const auto lane = static_cast<unsigned>(std::countr_zero(left));
            const auto offset = static_cast<std::uint64_t>(address(i, lane) - block->shared.data());
            words[count++] = offset / 4;
        }
        std::sort(words.begin(), words.begin() + count);
        const auto end = std::unique(words.begin(), words.begin() + count);
        std::array<std::uint8_t, warp_lanes> of_bank{};
        unsigned passes = 1;
        for (auto word = words.begin(); word != end; ++word)
            passes = std::max<unsigned>(passes, ++of_bank[*word % warp_lanes]);
        const double all = std::max<double>(
            passes, static_cast<double>(end - words.begin()) * static_cast<double>(bytes) / line_bytes);
        counts.memory_passes += all;
        return grid_.shared_latency + all;
    }
    std::array<std::uint64_t, 4 * warp_lanes> sectors{};
    unsigned count = 0;
    for (std::uint32_t left = mask; left != 0; left &= left - 1) {
        const auto at = reinterpret_cast<std::uint64_t>(address(i, static_cast<unsigned>(std::countr_zero(left))));
        for (std::uint64_t s = at / sector_bytes; s <= (at + bytes - 1) / sector_bytes && count < sectors.size(); ++s)
            if (count == 0 || sectors[count - 1] != s) sectors[count++] = s;
    }
    std::sort(sectors.begin(), sectors.begin() + count);
    const auto end = std::unique(sectors.begin(), sectors.begin() + count);
    std::uint64_t line = ~std::uint64_t{0};
    double passes = 0.0;
    bool misses = false;
    const bool is_cached = i.kind == PtxKind::load && !i.is_acquire;
    for (auto sector = sectors.begin(); sector != end; ++sector) {
        counts.sectors += 1.0;
        if (*sector / 4 != line) passes += 1.0;
        line = *sector / 4;
        if (!is_cached || !block->cache.ask(*sector)) {
            misses = true;
            counts.missed_sectors += 1.0;
            if (grid_.footprint.add(*sector)) counts.own_sectors += 1.0;
        }
    }
    counts.memory_passes += passes;
    if (i.kind == PtxKind::atomic) return grid_.atomic_latency;
    return passes + (misses ? grid_.second_cache_latency : grid_.first_cache_latency);
}

double PtxWarp::load(const PtxInstruction& i, std::uint32_t mask) {
    for (std::uint32_t left = mask; left != 0; left &= left - 1) {
        const auto lane = static_cast<unsigned>(std::countr_zero(left));
        const std::byte* const from = address(i, lane);
        std::array<std::uint64_t, 4> got{};
        for (unsigned k = 0; k < i.elements; ++k) {
            std::memcpy(&got[k], from + k * i.element_bytes, i.element_bytes);
            // Into a register of any width, of which a narrower one's readers take no more than they need.
            if (i.is_signed && i.element_bytes < 8) {
                const unsigned above = 64 - 8U * i.element_bytes;
                got[k] = static_cast<std::uint64_t>(static_cast<std::int64_t>(got[k] << above) >> above);
            }
        }
        for (unsigned k = 0; k < i.elements; ++k) values(i.to[k])[lane] = got[k];
    }
    return access(i, mask);
}

double PtxWarp::store(const PtxInstruction& i, std::uint32_t mask) {
    for (std::uint32_t left = mask; left != 0; left &= left - 1) {
        const auto lane = static_cast<unsigned>(std::countr_zero(left));
        std::byte* const to = address(i, lane);
        for (unsigned k = 0; k < i.elements; ++k)
            std::memcpy(to + k * i.element_bytes, &values(i.from[k + 1])[lane], i.element_bytes);
    }
    access(i, mask);
    return 0.0;
}

double PtxWarp::change(const PtxInstruction& i, std::uint32_t mask) {
    const unsigned bits = 8U * i.element_bytes;
    for (std::uint32_t left = mask; left != 0; left &= left - 1) {
        const auto lane = static_cast<unsigned>(std::countr_zero(left));
        std::byte* const at = address(i, lane);
        std::uint64_t before = 0;
        std::memcpy(&before, at, i.element_bytes);
        const std::uint64_t by = values(i.from[1])[lane];
        const auto number = [&](std::uint64_t value) {
            return static_cast<std::int64_t>(value << (64 - bits)) >> (64 - bits);
        };
        const bool by_is_greater = i.is_signed ? number(by) > number(before) : by > before;
        std::uint64_t after = by;
        switch (static_cast<PtxAtomic>(i.detail)) {
            case PtxAtomic::add:
                after = before + by;
                break;
            case PtxAtomic::bit_or:
                after = before | by;
                break;
            case PtxAtomic::bit_and:
                after = before & by;
                break;
            case PtxAtomic::max:
                after = by_is_greater ? by : before;
                break;
            case PtxAtomic::min:
                after = by_is_greater ? before : by;
                break;
            case PtxAtomic::compare_and_swap:
                after = before == by ? values(i.from[2])[lane] : before;
                break;
            case PtxAtomic::exchange:
            case PtxAtomic::unknown:
                break;
        }
        std::memcpy(at, &after, i.element_bytes);
        if (i.to[0] >= 0) values(i.to[0])[lane] = before;
    }
    if (i.opcode.find(".release") != std::string::npos) grid_.counts.grid_barriers += 1.0;
    return access(i, mask);
}

}  // namespace meniscus::benchmarks
