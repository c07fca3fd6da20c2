// Frames on their way to the disk: bounded in bytes, so that a slow disk costs frames, not memory.
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace meniscus::server {

/// Each value is of a name. What waits of one name has at most three times the room that it leaves free: a quarter
/// stays for the others, and some of that however many there are.
template <class T>
class WriteQueue {
public:
    /// limit: bytes that wait at most. A larger value is taken while nothing else waits.
    explicit WriteQueue(std::size_t limit) : limit_(limit) {}

    std::size_t limit() const noexcept { return limit_; }

    /// Room for a put() or a cancel() of this many bytes. Never waits; false if there is none.
    bool reserve(const std::string& name, std::size_t bytes) {
        const std::lock_guard lock(mutex_);
        if (bytes_ != 0 && !has_room(name, bytes)) return false;
        bytes_by_name_[name] += bytes;
        bytes_ += bytes;
        return true;
    }

    void cancel(const std::string& name, std::size_t bytes) {
        const std::lock_guard lock(mutex_);
        give_back(name, bytes);
    }

    /// Puts a value in, after reserve() of the same bytes for the name.
    // NOLINTNEXTLINE(performance-unnecessary-value-param): it is moved
    void put(T value, std::string name, std::size_t bytes) {
        {
            const std::lock_guard lock(mutex_);
            waiting_.push_back({.value = std::move(value), .name = std::move(name), .bytes = bytes});
        }
        changed_.notify_all();
    }

    /// Waits for the next value; none when the queue is closed and empty. It counts as waiting until the next take().
    std::optional<T> take() {
        std::unique_lock lock(mutex_);
        give_back(taken_name_, std::exchange(taken_, 0));
        changed_.wait(lock, [&] { return closed_ || !waiting_.empty(); });
        if (waiting_.empty()) return std::nullopt;
        std::optional<T> value(std::move(waiting_.front().value));
        taken_name_ = std::move(waiting_.front().name);
        taken_ = waiting_.front().bytes;
        waiting_.pop_front();
        if (waiting_.empty()) changed_.notify_all();
        return value;
    }

    /// Takes no more values; those that wait can still be taken.
    void close() {
        {
            const std::lock_guard lock(mutex_);
            closed_ = true;
        }
        changed_.notify_all();
    }

    /// Waits until everything has been taken, or the deadline. Gives each value that is left to `leave_out`.
    template <class LeaveOut>
    void finish(std::chrono::steady_clock::time_point deadline, LeaveOut leave_out) {
        std::deque<Waiting> left;  // what its end causes may put more into the queue
        {
            std::unique_lock lock(mutex_);
            changed_.wait_until(lock, deadline, [&] { return waiting_.empty(); });
            left.swap(waiting_);
            for (const Waiting& each : left) give_back(each.name, each.bytes);
        }
        for (Waiting& each : left) leave_out(each.value);
    }

private:
    struct Waiting {
        T value;
        std::string name;
        std::size_t bytes = 0;
    };

    bool has_room(const std::string& name, std::size_t bytes) const {
        const std::size_t free = limit_ - std::min(limit_, bytes_);
        if (bytes > free) return false;
        const auto own = bytes_by_name_.find(name);
        return (own == bytes_by_name_.end() ? 0 : own->second) + bytes <= 3 * (free - bytes);
    }

    void give_back(const std::string& name, std::size_t bytes) {
        const auto own = bytes_by_name_.find(name);
        if (own == bytes_by_name_.end()) return;
        bytes_ -= bytes;
        own->second -= bytes;
        if (own->second == 0) bytes_by_name_.erase(own);
    }

    const std::size_t limit_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Waiting> waiting_;
    std::size_t bytes_ = 0;  ///< reserved, waiting, or taken last
    std::map<std::string, std::size_t> bytes_by_name_;
    std::string taken_name_;
    std::size_t taken_ = 0;
    bool closed_ = false;
};

}  // namespace meniscus::server
