// How fast a frame comes in, and its answer is taken.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>

namespace meniscus::server {

/// A frame may take `time`. If it takes longer, it must have come with `bytes_per_second` since then.
struct LeastPace {
    std::chrono::duration<double> time{};  ///< 0: no limit
    std::size_t bytes_per_second = 0;      ///< 0: a frame that takes longer is too slow

    bool allows(std::size_t bytes, std::chrono::duration<double> taken) const {
        const double late = (taken - time).count();
        return time.count() == 0 || late < 0 ||
               static_cast<double>(bytes) > late * static_cast<double>(bytes_per_second);
    }
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
    /// The frame on its way in, if it comes too slowly.
    std::optional<Slow> too_slow(const LeastPace& least, Clock::time_point now) const {
        const std::lock_guard lock(mutex_);
        if (!frame_) return std::nullopt;
        Slow frame = *frame_;
        if (since_) frame.time += now - *since_;
        if (least.allows(frame.arrived, frame.time)) return std::nullopt;
        return frame;
    }

private:
    mutable std::mutex mutex_;
    std::optional<Slow> frame_;               ///< its time up to since_
    std::optional<Clock::time_point> since_;  ///< none: the clock stands still
};

}  // namespace meniscus::server
