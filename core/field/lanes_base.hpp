// The number of floats that are computed with at once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace meniscus {

template <int N>
struct Lanes;

/// The lanes of every set of eight lanes, ascending, then any others.
inline constexpr auto lanes_of_set = [] {
    std::array<std::array<std::int32_t, 8>, 256> table{};
    for (std::size_t set = 0; set < 256; ++set) {
        std::size_t count = 0;
        for (std::int32_t lane = 0; lane < 8; ++lane)
            if ((set >> lane & 1) != 0) table[set][count++] = lane;
    }
    return table;
}();

}  // namespace meniscus
