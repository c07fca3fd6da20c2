// The order in which sessions reconstruct on a device that they share.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>

namespace meniscus::server {

/// One turn at a time. Names take turns, and so do the sessions of each name: a name with many sessions has no more
/// turns than one with a single session. A session asks for one turn per frame. A turn that lasts for long is over once
/// somebody waits and there is room for two: the next one begins, and both go on side by side.
class Turns {
public:
    using Clock = std::chrono::steady_clock;

    /// longest: after which a turn is over for those who wait; none: it ends with its Turn alone. have_room: whether
    /// two may go on side by side; called with the lock held, asked again and again.
    explicit Turns(
        std::optional<Clock::duration> longest = std::nullopt, std::function<bool()> have_room = [] { return true; })
        : longest_(longest), have_room_(std::move(have_room)) {}

    /// Ends when it is destroyed.
    class Turn {
    public:
        Turn(Turns& turns, std::uint64_t number) : turns_(&turns), number_(number) {}
        ~Turn() {
            if (turns_ != nullptr) turns_->end(number_);
        }
        Turn(Turn&& other) noexcept : turns_(std::exchange(other.turns_, nullptr)), number_(other.number_) {}
        Turn(const Turn&) = delete;
        Turn& operator=(const Turn&) = delete;
        Turn& operator=(Turn&&) = delete;

    private:
        Turns* turns_;
        std::uint64_t number_;
    };

    /// Waits for at most one turn of each other name, and for those of its own name that were asked for before. None if
    /// the turn is given up: stop was requested before it began. name: the caller's that the session belongs to, or one
    /// that the session has for itself. session: for holder().
    std::optional<Turn> wait(const std::stop_token& stop, const std::string& name, const std::string& session = {});
    /// The session that has the present turn; empty: none.
    std::string holder();
    /// The number of threads that wait.
    std::uint64_t waiting();
    /// The time of all turns so far, the present one included; of one that was over, until the next one began.
    std::chrono::duration<double> taken();

private:
    /// The turns that wait under one name.
    struct Line {
        std::string name;
        std::deque<std::uint64_t> waiting{};  ///< the numbers of the turns that were asked for, the next one first
    };

    /// The name's, which may be new. With the lock held.
    Line& line_of(const std::string& name);
    void end(std::uint64_t number);
    // With the lock held.
    bool is_over() const { return !began_ || (longest_ && Clock::now() - *began_ >= *longest_ && have_room_()); }
    void end_present();

    const std::optional<Clock::duration> longest_;
    const std::function<bool()> have_room_;
    std::mutex mutex_;
    std::condition_variable_any changed_;
    std::uint64_t asked_ = 0;
    /// The lines of waiting names, the next one first. That with the present turn is last, and may be empty.
    std::list<Line> lines_;
    std::optional<Clock::time_point> began_;  ///< the present turn; none: there is none
    std::uint64_t number_ = 0;                ///< of the turn that began last
    std::string holder_;                      ///< of the present turn
    Clock::duration taken_{};                 ///< by the turns that have ended
};

}  // namespace meniscus::server
