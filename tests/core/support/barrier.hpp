// A std::barrier, which gcc 10 has not: the core's tests are built by it, too.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>

namespace meniscus::test {

class Barrier {
public:
    /// threads: the number of those that meet.
    explicit Barrier(std::size_t threads) : threads_(threads) {}
    void arrive_and_wait() {
        std::unique_lock lock(mutex_);
        if (++arrived_ == threads_) {
            arrived_ = 0;
            ++meetings_;
            met_.notify_all();
            return;
        }
        met_.wait(lock, [this, before = meetings_] { return meetings_ != before; });
    }

private:
    std::mutex mutex_;
    std::condition_variable met_;
    std::size_t threads_;
    std::size_t arrived_ = 0;
    std::size_t meetings_ = 0;
};

}  // namespace meniscus::test
