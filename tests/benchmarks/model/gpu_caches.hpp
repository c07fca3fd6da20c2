// The parts of a GPU's memory that a launch has asked for: for counts alone, no bytes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace meniscus::benchmarks {

constexpr std::uint64_t sector_bytes = 32;
constexpr std::uint64_t line_bytes = 128;

/// The first cache of one block: the newest line for each remainder, with a bit for each of its sectors that is there.
class FirstCache {
public:
    explicit FirstCache(std::uint64_t bytes) : lines_(std::max<std::uint64_t>(64, bytes / line_bytes)) {}
    /// Whether a sector was there already.
    bool ask(std::uint64_t sector) {
        const std::uint64_t line = sector / (line_bytes / sector_bytes);
        const auto bit = static_cast<std::uint8_t>(1U << sector % (line_bytes / sector_bytes));
        Line& at = lines_[line % lines_.size()];
        if (at.number != line) at = {line, 0};
        const bool was_there = (at.sectors & bit) != 0;
        at.sectors |= bit;
        return was_there;
    }

private:
    struct Line {
        std::uint64_t number = ~std::uint64_t{0};
        std::uint8_t sectors = 0;
    };
    std::vector<Line> lines_;
};

/// Different sectors of a launch.
class Footprint {
public:
    /// Whether the sector is a new one.
    bool add(std::uint64_t sector) {
        std::uint64_t& bits = seen_[sector / 64];
        const std::uint64_t bit = std::uint64_t{1} << sector % 64;
        const bool is_new = (bits & bit) == 0;
        bits |= bit;
        return is_new;
    }

private:
    std::unordered_map<std::uint64_t, std::uint64_t> seen_;
};

}  // namespace meniscus::benchmarks
