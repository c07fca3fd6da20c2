// Calls at times: once, mostly at a time that does not come, or again and again.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <thread>

namespace meniscus::server {

/// One thread for all calls, from the first on; what takes long has a timer of its own. A call that is set later than
/// the thread sleeps anyway does not wake it, so that one for each frame costs a lock.
class Timer {
public:
    using Clock = std::chrono::steady_clock;

    Timer() = default;
    /// Waits for the call under way.
    ~Timer();
    Timer(const Timer&) = delete;
    Timer& operator=(const Timer&) = delete;

    /// Returns a name for remove(). call: by the thread, must be short, not throw and not use the timer.
    std::uint64_t at(Clock::time_point time, std::function<void()> call);
    /// Calls it again and again, with this interval between two calls and before the first.
    std::uint64_t every(std::chrono::milliseconds interval, std::function<void()> call);
    /// From here on it is not called; one that is being called has returned. Does nothing for one that was called.
    void remove(std::uint64_t name);

private:
    struct Entry {
        Clock::time_point time;
        std::chrono::milliseconds interval;  ///< 0: once
        std::function<void()> call;
    };

    std::uint64_t add(Entry entry);
    void run();
    /// With the lock held.
    std::map<std::uint64_t, Entry>::iterator earliest();

    std::mutex mutex_;
    std::condition_variable changed_;
    std::map<std::uint64_t, Entry> entries_;  ///< one for each device at most, or few more
    std::uint64_t names_ = 0;
    Clock::time_point sleeps_until_ = Clock::time_point::max();
    bool stopping_ = false;
    std::thread thread_;  ///< from the first call on
};

}  // namespace meniscus::server
