// Durations at the edges of the server: flags, metrics, messages and texts state them as numbers of seconds.
#pragma once

#include <chrono>

namespace meniscus::server {

constexpr double seconds_of(std::chrono::duration<double> time) {
    return time.count();
}

/// Down to whole ones.
constexpr std::chrono::milliseconds milliseconds_of(double seconds) {
    return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::duration<double>(seconds));
}

}  // namespace meniscus::server
