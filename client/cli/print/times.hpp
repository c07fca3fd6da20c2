// Times as people read them.
#pragma once

#include <chrono>
#include <string>

namespace meniscus::cli {

/// The time in UTC, such as "2026-01-31T23:59:59Z".
std::string utc(std::chrono::system_clock::time_point time);
/// The time in its largest unit, cut: "59 s", "12 min", "3 h", "40 d". Below 0: "0 s".
std::string short_time(std::chrono::system_clock::duration time);

}  // namespace meniscus::cli
