// Frames that were dropped and whose simulator has not been told yet.
#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <utility>

namespace meniscus::server {

/// Dropped frames hold no slot that would slow their simulator down: this does, if it does not read what it is told.
/// Thread-safe.
class UnreportedDrops {
public:
    static constexpr std::size_t limit = 1024;

    void add() {
        const std::lock_guard lock(mutex_);
        ++count_;
    }

    void report() {
        std::function<void()> waiting;
        {
            const std::lock_guard lock(mutex_);
            if (--count_ < limit) waiting = std::exchange(waiting_, nullptr);
        }
        if (waiting) waiting();
    }

    /// Calls it once fewer than `limit` are unreported: at once, or from report(). One call may wait at a time.
    void when_below_limit(std::function<void()> call) {
        {
            const std::lock_guard lock(mutex_);
            if (count_ >= limit) {
                waiting_ = std::move(call);
                return;
            }
        }
        call();
    }

private:
    std::mutex mutex_;
    std::size_t count_ = 0;
    std::function<void()> waiting_;
};

}  // namespace meniscus::server
