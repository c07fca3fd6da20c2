// Frames on their way to the disk: bounded in bytes, so that a slow disk costs frames, not memory.
#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

namespace meniscus::server {

template <class T>
class WriteQueue {
public:
    /// limit: bytes that wait at most. A larger frame is taken while nothing else waits.
    explicit WriteQueue(std::size_t limit) : limit_(limit) {}

    std::size_t limit() const noexcept { return limit_; }

    /// Room for a put() or a cancel() of this many bytes. Never waits; false if there is none.
    bool reserve(std::size_t bytes) {
        const std::lock_guard lock(mutex_);
        if (bytes_ != 0 && bytes > limit_ - std::min(limit_, bytes_)) return false;
        bytes_ += bytes;
        return true;
    }

    void cancel(std::size_t bytes) {
        const std::lock_guard lock(mutex_);
        bytes_ -= bytes;
    }

    /// After reserve() of as many bytes.
    void put(T value, std::size_t bytes) {
        {
            const std::lock_guard lock(mutex_);
            values_.emplace_back(std::move(value), bytes);
        }
        changed_.notify_one();
    }

    /// Waits for the next value; none when the queue is closed and empty. It counts as waiting until the next take().
    std::optional<T> take() {
        std::unique_lock lock(mutex_);
        bytes_ -= std::exchange(taken_, 0);
        changed_.wait(lock, [&] { return closed_ || !values_.empty(); });
        if (values_.empty()) return std::nullopt;
        std::optional<T> value(std::move(values_.front().first));
        taken_ = values_.front().second;
        values_.pop_front();
        return value;
    }

    /// What waits can still be taken.
    void close() {
        {
            const std::lock_guard lock(mutex_);
            closed_ = true;
        }
        changed_.notify_all();
    }

private:
    const std::size_t limit_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::pair<T, std::size_t>> values_;
    std::size_t bytes_ = 0;  ///< reserved, waiting, or taken last
    std::size_t taken_ = 0;
    bool closed_ = false;
};

}  // namespace meniscus::server
