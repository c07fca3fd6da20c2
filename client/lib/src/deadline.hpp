// Until when to wait.
#pragma once

#include <algorithm>
#include <chrono>

namespace meniscus::client {

/// From now; a wait of years is one of ten, so that no sum overflows.
template <class Clock>
typename Clock::time_point deadline_after(std::chrono::milliseconds wait) {
    constexpr std::chrono::milliseconds longest = std::chrono::hours(24 * 365 * 10);
    return Clock::now() + std::chrono::duration_cast<typename Clock::duration>(
                              std::clamp(wait, std::chrono::milliseconds(0), longest));
}

}  // namespace meniscus::client
