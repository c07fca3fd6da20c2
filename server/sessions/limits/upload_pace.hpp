// How fast a frame comes in, and its answer is taken.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>

namespace meniscus::server {

/// A frame may take `time`. If it takes longer, it must come with `bytes_per_second` from then on: what came quickly
/// before is no credit for a standstill.
struct LeastPace {
    std::chrono::milliseconds time{};  ///< 0: no limit
    std::size_t bytes_per_second = 0;  ///< 0: a frame that takes longer is too slow
};

/// Measures a transfer against its least pace, in windows of five seconds, or of the time that it has if that is less.
/// Ask again and again.
class PaceCheck {
public:
    using Seconds = std::chrono::duration<double>;

    /// taken: of time, by the transfer up to now. bytes: transferred by now.
    bool too_slow(const LeastPace& least, Seconds taken, std::size_t bytes) {
        if (least.time.count() == 0) return false;
        const bool is_up = taken >= least.time;
        if (least.bytes_per_second == 0) return is_up;
        const Seconds passed = taken - begin_;
        if (passed < std::min<Seconds>(least.time, longest_window)) return false;
        const bool is_slow =
            static_cast<double>(bytes - bytes_) < passed.count() * static_cast<double>(least.bytes_per_second);
        begin_ = taken;
        bytes_ = bytes;
        return is_up && is_slow;
    }

private:
    /// Pauses of a connection are shorter.
    static constexpr Seconds longest_window{5.0};

    // The present window.
    Seconds begin_{};
    std::size_t bytes_ = 0;  ///< transferred before it
};

/// The clock stands still while the frame waits for the server. Thread-safe.
class UploadPace {
public:
    using Clock = std::chrono::steady_clock;

    struct Slow {
        std::uint64_t index = 0;
        std::size_t arrived = 0;    ///< bytes
        std::size_t announced = 0;  ///< bytes
        std::chrono::duration<double> time{};
    };

    void begin(std::uint64_t index, std::size_t announced, Clock::time_point now = Clock::now()) {
        const std::lock_guard lock(mutex_);
        frame_ = Slow{.index = index, .announced = announced};
        check_ = {};
        since_ = now;
    }
    void arrived(std::size_t bytes) {
        const std::lock_guard lock(mutex_);
        if (frame_) frame_->arrived += bytes;
    }
    void end() {
        const std::lock_guard lock(mutex_);
        frame_.reset();
    }
    /// The frame waits for the server.
    void pause(Clock::time_point now = Clock::now()) {
        const std::lock_guard lock(mutex_);
        if (!frame_ || !since_) return;
        frame_->time += now - *since_;
        since_.reset();
    }
    void resume(Clock::time_point now = Clock::now()) {
        const std::lock_guard lock(mutex_);
        since_ = now;
    }

    bool paused() const {
        const std::lock_guard lock(mutex_);
        return frame_ && !since_;
    }
    /// The frame on its way in, if it comes too slowly. Ask again and again.
    std::optional<Slow> too_slow(const LeastPace& least, Clock::time_point now) {
        const std::lock_guard lock(mutex_);
        if (!frame_) return std::nullopt;
        Slow frame = *frame_;
        if (since_) frame.time += now - *since_;
        if (!check_.too_slow(least, frame.time, frame.arrived)) return std::nullopt;
        return frame;
    }

private:
    mutable std::mutex mutex_;
    std::optional<Slow> frame_;  ///< its time up to since_
    PaceCheck check_;
    std::optional<Clock::time_point> since_;  ///< none: the clock stands still
};

}  // namespace meniscus::server
