#include "threads/worker.hpp"

#include <utility>

namespace meniscus::python {

Worker::~Worker() {
    {
        const std::lock_guard lock(mutex_);
        is_ending_ = true;
        changed_.notify_all();
    }
    thread_.join();
}

void Worker::begin(const std::function<void()>& work) {
    const std::lock_guard lock(mutex_);
    work_ = &work;
    changed_.notify_all();
}

bool Worker::wait(std::chrono::milliseconds limit) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, limit, [this] { return work_ == nullptr; });
}

std::exception_ptr Worker::error() {
    return std::exchange(error_, nullptr);
}

void Worker::run() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [this] { return work_ != nullptr || is_ending_; });
        if (work_ == nullptr) return;
        lock.unlock();
        std::exception_ptr error;
        try {
            (*work_)();
        } catch (...) {
            error = std::current_exception();
        }
        lock.lock();
        error_ = std::move(error);
        work_ = nullptr;
        changed_.notify_all();
    }
}

}  // namespace meniscus::python
