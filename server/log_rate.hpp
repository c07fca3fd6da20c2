// A limit on lines of the log that somebody outside can cause.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <utility>

namespace meniscus::server {

/// For lines of one kind: a bucket of `burst` lines that fills at `per_second`. Thread-safe.
class LogRate {
public:
    using Clock = std::chrono::steady_clock;

    /// Both are greater than 0.
    LogRate(double per_second, double burst) : per_second_(per_second), burst_(burst), lines_(burst) {}

    /// Whether a line may be written now: then the number of those that were left out since the one before.
    std::optional<std::uint64_t> admit(Clock::time_point now = Clock::now()) {
        const std::lock_guard lock(mutex_);
        if (filled_at_)
            lines_ = std::min(burst_, lines_ + per_second_ * std::chrono::duration<double>(now - *filled_at_).count());
        filled_at_ = now;
        if (lines_ < 1.0) {
            ++left_out_;
            return std::nullopt;
        }
        lines_ -= 1.0;
        return std::exchange(left_out_, 0);
    }

private:
    const double per_second_;
    const double burst_;
    std::mutex mutex_;
    double lines_;
    std::optional<Clock::time_point> filled_at_;
    std::uint64_t left_out_ = 0;
};

}  // namespace meniscus::server
