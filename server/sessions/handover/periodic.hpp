// Calls a function again and again, on a thread of its own.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace meniscus::server {

class Periodic {
public:
    /// Calls it once per interval, until it is destroyed.
    Periodic(std::chrono::milliseconds interval, std::function<void()> call)
        : thread_([this, interval, work = std::move(call)] {
              std::unique_lock lock(mutex_);
              while (!stopped_.wait_for(lock, interval, [this] { return stopping_; })) {
                  lock.unlock();
                  work();
                  lock.lock();
              }
          }) {}
    ~Periodic() {
        {
            const std::lock_guard lock(mutex_);
            stopping_ = true;
        }
        stopped_.notify_all();
        thread_.join();
    }
    Periodic(const Periodic&) = delete;
    Periodic& operator=(const Periodic&) = delete;

private:
    std::mutex mutex_;
    std::condition_variable stopped_;
    bool stopping_ = false;
    std::thread thread_;  ///< last: it uses the others
};

}  // namespace meniscus::server
