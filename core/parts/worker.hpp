// A thread that does one thing at a time.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

namespace meniscus {

class Worker {
public:
    /// Does what has begun, and ends.
    ~Worker() { wait(); }

    /// work: must throw nothing. Nothing else is being done.
    void start(std::function<void()> work) {
        const std::lock_guard lock(mutex_);
        // With the first work: a process that never has any needs no thread. Where the system refuses it, nothing is
        // done.
        if (!thread_.joinable()) thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
        work_ = std::move(work);
        changed_.notify_all();
    }
    bool is_idle() const {
        const std::lock_guard lock(mutex_);
        return !work_;
    }
    void wait() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return !work_; });
    }

private:
    void run(const std::stop_token& stop) {
        std::unique_lock lock(mutex_);
        while (changed_.wait(lock, stop, [this] { return static_cast<bool>(work_); })) {
            lock.unlock();
            work_();
            lock.lock();
            work_ = nullptr;
            changed_.notify_all();
        }
    }

    mutable std::mutex mutex_;
    std::condition_variable_any changed_;
    std::function<void()> work_;  ///< none: idle
    std::jthread thread_;         ///< goes first
};

}  // namespace meniscus
