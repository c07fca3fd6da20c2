// A few reusable objects, lent in the order of the requests.
#pragma once

#include <deque>
#include <functional>
#include <mutex>
#include <utility>

namespace meniscus::server {

/// Nobody blocks here: a request leaves a function that is called when a slot is free, at once or by the thread that
/// gives one back. That is how a stream is slowed down without holding a gRPC thread.
template <class T>
class SlotPool {
public:
    /// Takes the slot by returning true; false leaves it to the next.
    using Waiter = std::function<bool(T&)>;

    void request(Waiter waiter) {
        {
            const std::lock_guard lock(mutex_);
            if (closed_) return;
            waiters_.push_back(std::move(waiter));
        }
        lend();
    }

    void give(T& slot) {
        {
            const std::lock_guard lock(mutex_);
            free_.push_back(&slot);
        }
        lend();
    }

    /// Takes this slot out of turn. False unless it is free.
    bool take(T& slot) {
        const std::lock_guard lock(mutex_);
        return std::erase(free_, &slot) != 0;
    }

    /// Drops the requests that wait, and those that come from now on.
    void close() {
        std::deque<Waiter> forgotten;  // destroyed outside of the lock
        const std::lock_guard lock(mutex_);
        closed_ = true;
        forgotten.swap(waiters_);
    }

private:
    void lend() {
        for (;;) {
            T* slot = nullptr;
            Waiter waiter;
            {
                const std::lock_guard lock(mutex_);
                if (free_.empty() || waiters_.empty()) return;
                slot = free_.front();
                free_.pop_front();
                waiter = std::move(waiters_.front());
                waiters_.pop_front();
            }
            if (waiter(*slot)) continue;
            const std::lock_guard lock(mutex_);
            free_.push_front(slot);
        }
    }

    std::mutex mutex_;
    std::deque<T*> free_;
    std::deque<Waiter> waiters_;
    bool closed_ = false;
};

}  // namespace meniscus::server
