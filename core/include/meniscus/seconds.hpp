// Durations at the edges of the programs: flags, options by text, metrics and messages state them as numbers of
// seconds.
#pragma once

#include <chrono>

namespace meniscus {

constexpr double seconds_of(std::chrono::duration<double> time) {
    return time.count();
}

/// The nearest whole number of them.
constexpr std::chrono::milliseconds milliseconds_of(double seconds) {
    return std::chrono::round<std::chrono::milliseconds>(std::chrono::duration<double>(seconds));
}

}  // namespace meniscus
