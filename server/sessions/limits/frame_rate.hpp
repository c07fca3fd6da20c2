// The limit of frames that a session, or a caller, may begin in a second.
#pragma once

#include <chrono>
#include <cstdint>

namespace meniscus::server {

/// A token bucket that holds a second's frames. Not thread-safe.
class FrameRate {
public:
    using Clock = std::chrono::steady_clock;

    /// limit: frames per second, 0 for none.
    explicit FrameRate(std::uint32_t limit) : limit_(limit), tokens_(limit) {}

    /// Returns whether one more frame may begin at this time; if so, counts it.
    bool take(Clock::time_point now);
    /// Returns whether a second's frames may begin now, as if none had been before.
    bool full(Clock::time_point now) const { return tokens_at(now) >= limit_; }

private:
    double tokens_at(Clock::time_point now) const;

    double limit_;
    double tokens_;
    Clock::time_point filled_at_{};
};

}  // namespace meniscus::server
