// The threads that encode bricks, shared by all sessions.
//
// Not oneTBB's task_arena, which core uses: the thread sanitizer reports about 30 races in Debian's build of it, and a
// caller that waits there may be given another session's work.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <list>
#include <mutex>
#include <thread>
#include <vector>

namespace meniscus::server {

class WorkerPool {
public:
    /// threads: how many work at the same time on one loop, its caller included; at least 1.
    explicit WorkerPool(unsigned threads);
    ~WorkerPool();
    WorkerPool(const WorkerPool&) = delete;
    WorkerPool& operator=(const WorkerPool&) = delete;

    /// Calls body(0) ... body(count - 1), in parallel and in any order, and waits for all. The caller works too, so
    /// that a loop never waits for another session's. Rethrows the first exception; the indices not yet begun are then
    /// left out.
    void for_each(std::size_t count, const std::function<void(std::size_t)>& body);

private:
    struct Loop {
        std::size_t count = 0;
        const std::function<void(std::size_t)>* body = nullptr;
        std::size_t next = 0;  ///< index to begin with next
        unsigned workers = 0;  ///< threads inside
        std::exception_ptr error;
    };

    void work();
    /// Ends the threads.
    void stop();
    /// Takes indices from the loop until there are none; entered and left with the lock held.
    void help(Loop& loop, std::unique_lock<std::mutex>& lock);

    std::mutex mutex_;
    std::condition_variable work_;
    std::condition_variable done_;
    std::list<Loop*> loops_;  ///< those with indices left
    bool stopping_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace meniscus::server
