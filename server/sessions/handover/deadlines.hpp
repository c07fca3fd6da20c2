// Calls at times that mostly do not come.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <thread>

namespace meniscus::server {

/// One thread for all. A deadline that is set later than the thread sleeps anyway does not wake it, so that one for
/// each frame costs a lock.
class Deadlines {
public:
    using Clock = std::chrono::steady_clock;

    Deadlines() = default;
    ~Deadlines();
    Deadlines(const Deadlines&) = delete;
    Deadlines& operator=(const Deadlines&) = delete;

    /// Returns a name for remove(). call: by the thread, must be short and not throw.
    std::uint64_t add(Clock::time_point at, std::function<void()> call);
    /// From here on it is not called; one that is being called has returned. Does nothing for one that was called.
    void remove(std::uint64_t name);

private:
    struct Entry {
        Clock::time_point at;
        std::function<void()> call;
    };

    void run();
    /// With the lock held.
    std::map<std::uint64_t, Entry>::iterator earliest();

    std::mutex mutex_;
    std::condition_variable changed_;
    std::map<std::uint64_t, Entry> entries_;  ///< one for each device at most, or few more
    std::uint64_t names_ = 0;
    Clock::time_point sleeps_until_ = Clock::time_point::max();
    bool stopping_ = false;
    std::thread thread_;  ///< from the first deadline on
};

}  // namespace meniscus::server
