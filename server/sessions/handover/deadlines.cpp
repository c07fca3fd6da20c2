#include "sessions/handover/deadlines.hpp"

#include <algorithm>
#include <utility>

namespace meniscus::server {

Deadlines::~Deadlines() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

std::uint64_t Deadlines::add(Clock::time_point at, std::function<void()> call) {
    bool wake = false;
    std::uint64_t name = 0;
    {
        const std::lock_guard lock(mutex_);
        name = ++names_;
        entries_.emplace(name, Entry{.at = at, .call = std::move(call)});
        wake = at < sleeps_until_;
        if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
    }
    if (wake) changed_.notify_all();
    return name;
}

void Deadlines::remove(std::uint64_t name) {
    const std::lock_guard lock(mutex_);
    entries_.erase(name);
}

std::map<std::uint64_t, Deadlines::Entry>::iterator Deadlines::earliest() {
    return std::ranges::min_element(entries_, {}, [](const auto& entry) { return entry.second.at; });
}

void Deadlines::run() {
    std::unique_lock lock(mutex_);
    while (!stopping_) {
        const auto next = earliest();
        if (next != entries_.end() && next->second.at <= Clock::now()) {
            // With the lock held, so that remove() waits for it.
            next->second.call();
            entries_.erase(next);
            continue;
        }
        sleeps_until_ = next != entries_.end() ? next->second.at : Clock::time_point::max();
        if (next != entries_.end())
            changed_.wait_until(lock, sleeps_until_);
        else
            changed_.wait(lock);
    }
}

}  // namespace meniscus::server
