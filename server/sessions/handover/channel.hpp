// Hands values from one thread to another, in order.
//
// Not oneTBB's concurrent_bounded_queue: the thread sanitizer reports false races in Debian's build of it, and closing
// it ends a wait with an exception.
#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

namespace meniscus::server {

/// put() never waits: what travels here is bounded by the number of frame and mesh slots, not by the channel.
template <class T>
class Channel {
public:
    /// Dropped once the channel is closed.
    void put(T value) {
        {
            const std::lock_guard lock(mutex_);
            if (closed_) return;
            values_.push_back(std::move(value));
        }
        changed_.notify_one();
    }

    /// Waits for the next value; none once the channel is closed.
    std::optional<T> take() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return closed_ || !values_.empty(); });
        if (closed_) return std::nullopt;
        std::optional<T> value(std::move(values_.front()));
        values_.pop_front();
        return value;
    }

    /// Discards what has not been taken.
    void close() {
        std::deque<T> discarded;  // destroyed outside of the lock
        {
            const std::lock_guard lock(mutex_);
            closed_ = true;
            discarded.swap(values_);
        }
        changed_.notify_all();
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<T> values_;
    bool closed_ = false;
};

}  // namespace meniscus::server
