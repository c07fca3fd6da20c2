// The long calls that run now: a server that stops waits for them.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
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

        /// The call's client has taken something.
        void progress() const { ++calls_.progress_; }

    private:
        ActiveCalls& calls_;
    };

    /// Returns false if calls still run at the deadline.
    bool wait_until_none(
        std::chrono::system_clock::time_point deadline = std::chrono::system_clock::time_point::max()) {
        std::unique_lock lock(mutex_);
        return none_.wait_until(lock, deadline, [&] { return count_ == 0; });
    }

    /// Waits as wait_until_none() does, and returns false also if no call makes progress within `patience`.
    bool wait_while_they_progress(std::chrono::system_clock::time_point deadline, std::chrono::milliseconds patience) {
        for (;;) {
            const std::uint64_t before = progress_;
            const auto patient_until = std::chrono::system_clock::now() + patience;
            if (wait_until_none(std::min(deadline, patient_until))) return true;
            if (patient_until >= deadline || progress_ == before) return false;
        }
    }

private:
    std::atomic<std::uint64_t> progress_{0};
    std::mutex mutex_;  ///< for what follows
    std::condition_variable none_;
    std::size_t count_ = 0;
};

}  // namespace meniscus::server
