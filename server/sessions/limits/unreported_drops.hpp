// The number of dropped frames that were not yet reported to their simulator.
#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

namespace meniscus::server {

/// Dropped frames hold no slot that would slow down their simulator. This number does, if the simulator does not read
/// the reports.
/// Thread-safe.
class UnreportedDrops {
public:
    static constexpr std::size_t limit = 1024;

    void add() {
        const std::lock_guard lock(mutex_);
        ++count_;
    }

    void report() {
        std::vector<std::function<void()>> waiting;
        {
            const std::lock_guard lock(mutex_);
            if (--count_ < limit) waiting = std::exchange(waiting_, {});
        }
        for (const auto& call : waiting) call();
    }

    /// Calls the function once fewer than `limit` are unreported: at once, or from report().
    void when_below_limit(std::function<void()> call) {
        {
            const std::lock_guard lock(mutex_);
            if (count_ >= limit) {
                waiting_.push_back(std::move(call));
                return;
            }
        }
        call();
    }

private:
    std::mutex mutex_;
    std::size_t count_ = 0;
    std::vector<std::function<void()>> waiting_;
};

}  // namespace meniscus::server
