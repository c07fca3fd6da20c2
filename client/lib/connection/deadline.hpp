// Until when to wait.
#pragma once

#include <algorithm>
#include <chrono>

namespace meniscus::client {

/// A wait of years is one of ten, so that no sum overflows.
inline constexpr std::chrono::milliseconds longest_wait = std::chrono::hours(24 * 365 * 10);

/// The time that lies this far from now.
template <class Clock>
typename Clock::time_point deadline_after(std::chrono::milliseconds wait) {
    return Clock::now() + std::chrono::duration_cast<typename Clock::duration>(
                              std::clamp(wait, std::chrono::milliseconds(0), longest_wait));
}

}  // namespace meniscus::client
