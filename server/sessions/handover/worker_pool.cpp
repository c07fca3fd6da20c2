#include "sessions/handover/worker_pool.hpp"

namespace meniscus::server {

WorkerPool::WorkerPool(unsigned threads) {
    threads_.reserve(threads);
    try {
        for (unsigned i = 1; i < threads; ++i) threads_.emplace_back([this] { work(); });
    } catch (...) {  // the system refuses a thread
        stop();
        throw;
    }
}

WorkerPool::~WorkerPool() {
    stop();
}

void WorkerPool::stop() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    work_.notify_all();
    for (std::thread& thread : threads_) thread.join();
}

void WorkerPool::for_each(std::size_t count, const std::function<void(std::size_t)>& body) {
    if (count == 0) return;
    Loop loop{.count = count, .body = &body, .error = nullptr};
    std::unique_lock lock(mutex_);
    loops_.push_back(&loop);
    if (count > 1) work_.notify_all();
    help(loop, lock);
    done_.wait(lock, [&] { return loop.workers == 0; });
    if (loop.error) std::rethrow_exception(loop.error);
}

void WorkerPool::work() {
    std::unique_lock lock(mutex_);
    for (;;) {
        work_.wait(lock, [&] { return stopping_ || !loops_.empty(); });
        if (stopping_) return;
        help(*loops_.front(), lock);
    }
}

void WorkerPool::help(Loop& loop, std::unique_lock<std::mutex>& lock) {
    ++loop.workers;
    while (loop.next < loop.count) {
        const std::size_t index = loop.next++;
        if (loop.next == loop.count) loops_.remove(&loop);
        lock.unlock();
        std::exception_ptr error;
        try {
            (*loop.body)(index);
        } catch (...) {
            error = std::current_exception();
        }
        lock.lock();
        if (error) {
            if (!loop.error) loop.error = error;
            loop.next = loop.count;
            loops_.remove(&loop);
        }
    }
    if (--loop.workers == 0) done_.notify_all();
}

}  // namespace meniscus::server
