// The order in which sessions reconstruct on a device that they share.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>

namespace meniscus::server {

/// One turn at a time. Names take turns, and so do the sessions of each name: a name with many sessions has no more
/// turns than one with a single session. A session asks for one turn per frame. A turn that lasts for long is over once
/// another name waits: its turn begins, and both go on side by side. So that many long ones do not add up, a turn lasts
/// for a 32nd of that once the next one has itself waited for as long. No name has two turns at a time. The one that
/// began first leads, until it has ended: so that what two cannot have at a time, such as most of the memory, is one's
/// alone. A turn that begins while none leads, leads.
class Turns {
public:
    using Clock = std::chrono::steady_clock;

    /// longest: after which a turn is over for other names; none: it ends with its Turn alone, and each leads.
    explicit Turns(std::optional<Clock::duration> longest = std::nullopt) : longest_(longest) {}

    enum class Needs : std::uint8_t {
        any_turn,
        to_lead,  ///< others pass by while one leads that has begun before
    };

    /// Ends when it is destroyed.
    class Turn {
    public:
        Turn(Turns& turns, std::uint64_t number, bool leads) : turns_(&turns), number_(number), leads_(leads) {}
        ~Turn() {
            if (turns_ != nullptr) turns_->end(number_);
        }
        Turn(Turn&& other) noexcept
            : turns_(std::exchange(other.turns_, nullptr)), number_(other.number_), leads_(other.leads_) {}
        Turn(const Turn&) = delete;
        Turn& operator=(const Turn&) = delete;
        Turn& operator=(Turn&&) = delete;

        bool leads() const noexcept { return leads_; }

    private:
        Turns* turns_;
        std::uint64_t number_;
        bool leads_;
    };

    /// Waits for at most one turn of each other name, and for those of its own name that were asked for before. None if
    /// the turn is given up: stop was requested before it began. name: the caller's that the session belongs to, or one
    /// that the session has for itself. session: for holder().
    std::optional<Turn> wait(const std::stop_token& stop, const std::string& name, const std::string& session = {},
                             Needs needs = Needs::any_turn);
    /// The session that has the present turn; empty: none.
    std::string holder();
    /// The number of threads that wait.
    std::uint64_t waiting();
    /// The time of all turns so far, the present one included; of one that was over, until the next one began.
    std::chrono::duration<double> taken();

private:
    struct Asked {
        std::uint64_t number;
        Needs needs;
        Clock::time_point since;
    };
    /// The turns that wait under one name.
    struct Line {
        std::string name;
        std::deque<Asked> waiting{};  ///< the next one first
    };
    using Lines = std::list<Line>;

    void end(std::uint64_t number);
    // With the lock held.
    /// The name's, which may be new.
    Lines::iterator line_of(const std::string& name);
    /// The number of the turn that begins next; none where no waiting one may begin.
    std::optional<std::uint64_t> next() const;
    /// When the present turn is over for one that has waited since then. There are a present turn and a longest one.
    Clock::time_point over_at(Clock::time_point waits_since) const;
    bool is_over(Clock::time_point waits_since) const {
        return !began_ || (longest_ && Clock::now() >= over_at(waits_since));
    }
    void end_present();

    const std::optional<Clock::duration> longest_;
    std::mutex mutex_;
    std::condition_variable_any changed_;
    std::uint64_t asked_ = 0;
    /// The lines of waiting names, the next one first. That with the present turn is last, and may be empty.
    Lines lines_;
    std::optional<Clock::time_point> began_;          ///< the present turn; none: there is none
    std::uint64_t number_ = 0;                        ///< of the turn that began last
    std::map<std::uint64_t, std::string> under_way_;  ///< names by the numbers of the turns that have not ended
    std::uint64_t leader_ = 0;                        ///< the number of the turn that leads; 0: none
    std::string holder_;                              ///< of the present turn
    Clock::duration taken_{};                         ///< by the turns that have ended
};

}  // namespace meniscus::server
