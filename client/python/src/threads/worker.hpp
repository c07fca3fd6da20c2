// A thread that does one work after the other.
#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace meniscus::python {

class Worker {
public:
    Worker() : thread_([this] { run(); }) {}
    ~Worker();
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    /// Returns at once. The work lives until wait() returns true.
    void begin(const std::function<void()>& work);
    /// Returns whether the work is done.
    bool wait(std::chrono::milliseconds limit);
    /// The exception of the work that is done; none if it threw nothing.
    std::exception_ptr error();

private:
    void run();

    std::mutex mutex_;
    std::condition_variable changed_;
    const std::function<void()>* work_ = nullptr;  ///< none: it is done
    std::exception_ptr error_;
    bool is_ending_ = false;
    std::thread thread_;  ///< the last, for it uses the others
};

}  // namespace meniscus::python
