// The long calls that run now: a server that stops waits for them.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>

namespace meniscus::server {

class ActiveCalls {
public:
    /// Held by a call from its start until it is done.
    class Token {
    public:
        explicit Token(ActiveCalls& calls) : calls_(calls) {
            const std::lock_guard lock(calls_.mutex_);
            ++calls_.count_;
        }
        ~Token() {
            const std::lock_guard lock(calls_.mutex_);
            if (--calls_.count_ == 0) calls_.none_.notify_all();
        }
        Token(const Token&) = delete;
        Token& operator=(const Token&) = delete;

    private:
        ActiveCalls& calls_;
    };

    /// Returns false if calls still run at the deadline.
    bool wait_until_none(std::chrono::system_clock::time_point deadline) {
        std::unique_lock lock(mutex_);
        return none_.wait_until(lock, deadline, [&] { return count_ == 0; });
    }

private:
    std::mutex mutex_;
    std::condition_variable none_;
    std::size_t count_ = 0;
};

}  // namespace meniscus::server
