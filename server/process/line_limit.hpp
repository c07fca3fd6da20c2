// Keeps lines of one kind, which strangers can cause, from filling the log.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace meniscus::server {

/// Lets the first `burst` lines of each interval pass. Thread-safe.
class LineLimit {
public:
    using Clock = std::chrono::steady_clock;

    explicit LineLimit(std::uint32_t burst = 1, Clock::duration interval = std::chrono::seconds(10))
        : burst_(burst), interval_(interval) {}

    /// The lines that were kept back since the one before; none if this one is to be kept back, too.
    std::optional<std::uint64_t> pass(Clock::time_point now = Clock::now()) {
        const std::lock_guard lock(mutex_);
        if (now >= end_) {
            end_ = now + interval_;
            passed_ = 0;
        }
        if (passed_ >= burst_) {
            ++kept_back_;
            return std::nullopt;
        }
        ++passed_;
        return std::exchange(kept_back_, 0);
    }

private:
    const std::uint32_t burst_;
    const Clock::duration interval_;
    std::mutex mutex_;  ///< for what follows
    Clock::time_point end_{};
    std::uint32_t passed_ = 0;
    std::uint64_t kept_back_ = 0;
};

/// For the end of a line that has passed: "" or " (99 lines like it were left out)".
inline std::string left_out(std::uint64_t lines) {
    if (lines == 0) return {};
    return " (" + std::to_string(lines) +
           (lines == 1 ? " line like it was left out)" : " lines like it were left out)");
}

}  // namespace meniscus::server
