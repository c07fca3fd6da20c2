// When the levels of a cell have risen while the band settled: by this the states of two parts of a frame are compared.
#pragma once

#include <cstdint>

#include "lattice/host_device.hpp"

namespace meniscus {

/// A moment while the band settles: the same cell goes up for the same rule at the same moment in the whole frame and
/// in each part that sees what the rule looks at. Rounds of step 4 are counted from 1; step 3 before them is round 0.
struct SettlingTime {
    std::uint32_t round = 0;
    std::uint32_t step = 0;

    // The steps of a round: cells join the band, go up at slivers, then balance and promotion take turns.
    static constexpr std::uint32_t joining = 0;
    static constexpr std::uint32_t slivers = 1;
    static constexpr std::uint32_t adjusting = 2;

    /// A number for each moment; never 0.
    MENISCUS_HD std::uint64_t number() const { return std::uint64_t{round} << 32 | step; }
};

/// For each level, 1 to 3, the moment at which the cell has reached it; 0 where it had it from the begin, or never has
/// it.
struct RaiseTimes {
    std::uint64_t at[3];

    MENISCUS_HD void note(int before, int after, const SettlingTime& now) {
        for (int level = before; level < after; ++level) at[level] = now.number();
    }
};

}  // namespace meniscus
