// The order in which sessions reconstruct on a device that they share.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>

namespace meniscus::server {

/// One turn at a time, first come, first served. A session asks for one turn per frame, so that sessions with frames
/// alternate.
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

    /// Waits until all turns that were asked for before have ended or been given up. None if the turn is given up: stop
    /// was requested before it began. who: a name for holder().
    std::optional<Turn> wait(const std::stop_token& stop, const std::string& who = {});
    /// Who has the present turn; empty: nobody.
    std::string holder();
    /// The number of threads that wait.
    std::uint64_t waiting();
    /// The time of all turns so far, the present one included.
    std::chrono::duration<double> taken();

private:
    using Clock = std::chrono::steady_clock;

    void end();

    std::mutex mutex_;
    std::condition_variable_any changed_;
    std::uint64_t asked_ = 0;
    std::deque<std::uint64_t> waiting_;       ///< the numbers of the turns that were asked for, the next one first
    std::optional<Clock::time_point> began_;  ///< the present turn; none: there is none
    std::string holder_;                      ///< of the present turn
    Clock::duration taken_{};                 ///< by the turns that have ended
};

}  // namespace meniscus::server
