// Whose frame is reconstructed next, on a device that sessions share.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <utility>

namespace meniscus::server {

/// One turn at a time, first come, first served. A session asks for one turn per frame, so that those who have frames
/// go round.
class Turns {
public:
    /// Ends when it is destroyed.
    class Turn {
    public:
        explicit Turn(Turns& turns) : turns_(&turns) {}
        ~Turn() {
            if (turns_ != nullptr) turns_->end();
        }
        Turn(Turn&& other) noexcept : turns_(std::exchange(other.turns_, nullptr)) {}
        Turn(const Turn&) = delete;
        Turn& operator=(const Turn&) = delete;
        Turn& operator=(Turn&&) = delete;

    private:
        Turns* turns_;
    };

    /// Waits until all who asked before have had theirs.
    Turn wait();
    /// How many wait now.
    std::uint64_t waiting();
    /// Of all turns so far, with what the one that goes on has taken.
    std::chrono::duration<double> taken();

private:
    using Clock = std::chrono::steady_clock;

    void end();

    std::mutex mutex_;
    std::condition_variable ended_;
    std::uint64_t asked_ = 0;
    std::uint64_t current_ = 0;
    std::optional<Clock::time_point> began_;  ///< the turn that goes on; none: nobody's
    Clock::duration taken_{};                 ///< by those that ended
};

}  // namespace meniscus::server
