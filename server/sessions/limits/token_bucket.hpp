// A rate that holds in the mean.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace meniscus::server {

/// The bucket fills at the rate, up to one second's bytes. A frame may go when it is not in debt, and may take more
/// than it holds, so that whole frames go out whatever their size; the next one then waits until the debt is paid.
/// Times must not decrease.
class TokenBucket {
public:
    using Clock = std::chrono::steady_clock;

    /// bytes_per_second: greater than 0.
    TokenBucket(std::uint64_t bytes_per_second, Clock::time_point now)
        : rate_(static_cast<double>(bytes_per_second)), tokens_(rate_), filled_at_(now) {}

    /// When the next frame may go; `now` if it may at once.
    Clock::time_point ready_at(Clock::time_point now) const {
        const double tokens = tokens_at(now);
        if (tokens >= 0.0) return now;
        // A rate of one byte per second and a frame of gigabytes: longer than anybody waits, and no overflow.
        const double seconds = std::min(-tokens / rate_, 1e6);
        return now + std::chrono::ceil<Clock::duration>(std::chrono::duration<double>(seconds));
    }

    void spend(std::uint64_t bytes, Clock::time_point now) {
        tokens_ = tokens_at(now) - static_cast<double>(bytes);
        filled_at_ = now;
    }

private:
    double tokens_at(Clock::time_point now) const {
        return std::min(rate_, tokens_ + rate_ * std::chrono::duration<double>(now - filled_at_).count());
    }

    const double rate_;
    double tokens_;  ///< below 0: a debt
    Clock::time_point filled_at_;
};

}  // namespace meniscus::server
