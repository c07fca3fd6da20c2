// Memory that sessions without frames give back, for those that have some.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

namespace meniscus::server {

class Session;

/// The sessions that are asked for their buffers when memory runs short. Thread-safe.
class IdleBuffers {
public:
    void add(const std::weak_ptr<Session>& session);
    /// Lets idle sessions give their buffers back, the one first that has rested longest, until there is room. Called
    /// by the thread of a session that reconstructs. is_room: whether there is.
    void make_room(const std::function<bool()>& is_room);
    /// No room could be made.
    void note_shortage() { last_shortage_ = Clock::now(); }
    /// Whether that was noted, not longer ago than this.
    bool short_within(std::chrono::duration<double> time) const { return Clock::now() - last_shortage_.load() <= time; }

private:
    using Clock = std::chrono::steady_clock;

    /// The time for sessions to give their buffers back.
    static constexpr auto patience = std::chrono::seconds(1);

    /// Longer ago than anybody asks.
    std::atomic<Clock::time_point> last_shortage_{Clock::now() - std::chrono::hours(24 * 365)};
    std::mutex mutex_;
    std::vector<std::weak_ptr<Session>> sessions_;
};

}  // namespace meniscus::server
