#include "sessions/handover/timer.hpp"

#include <algorithm>
#include <utility>

namespace meniscus::server {

Timer::~Timer() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

std::uint64_t Timer::at(Clock::time_point time, std::function<void()> call) {
    return add({.time = time, .interval = {}, .call = std::move(call)});
}

std::uint64_t Timer::every(std::chrono::milliseconds interval, std::function<void()> call) {
    return add({.time = Clock::now() + interval, .interval = interval, .call = std::move(call)});
}

std::uint64_t Timer::add(Entry entry) {
    bool wake = false;
    std::uint64_t name = 0;
    {
        const std::lock_guard lock(mutex_);
        // First: where the system refuses it, nothing is to be called.
        if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
        name = ++names_;
        wake = entry.time < sleeps_until_;
        entries_.emplace(name, std::move(entry));
    }
    if (wake) changed_.notify_all();
    return name;
}

void Timer::remove(std::uint64_t name) {
    const std::lock_guard lock(mutex_);
    entries_.erase(name);
}

std::map<std::uint64_t, Timer::Entry>::iterator Timer::earliest() {
    return std::ranges::min_element(entries_, {}, [](const auto& entry) { return entry.second.time; });
}

void Timer::run() {
    std::unique_lock lock(mutex_);
    while (!stopping_) {
        const auto next = earliest();
        if (next != entries_.end() && next->second.time <= Clock::now()) {
            // With the lock held, so that remove() waits for it.
            next->second.call();
            if (next->second.interval.count() != 0)
                next->second.time = Clock::now() + next->second.interval;
            else
                entries_.erase(next);
            continue;
        }
        sleeps_until_ = next != entries_.end() ? next->second.time : Clock::time_point::max();
        if (next != entries_.end())
            changed_.wait_until(lock, sleeps_until_);
        else
            changed_.wait(lock);
    }
}

}  // namespace meniscus::server
