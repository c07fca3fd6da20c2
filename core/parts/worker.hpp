// A thread that does one thing at a time.
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

namespace meniscus {

class Worker {
public:
    /// Does what has begun, and ends.
    ~Worker() { wait(); }

    /// work: must throw nothing. Nothing else is being done. Where the system refuses a thread, it is done by the
    /// caller's.
    void start(std::function<void()> work) {
        if (!has_thread()) return work();
        const std::lock_guard lock(mutex_);
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
    /// From the first work on: a process that never has any needs none.
    bool has_thread() {
        try {
            if (!thread_.joinable()) thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
            return true;
        } catch (const std::exception&) {
            return false;
        }
    }
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
