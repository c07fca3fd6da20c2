// Ends the process at the end of its grace period, whatever still runs: a reconstruction cannot be interrupted.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace meniscus::server {

/// Construct it before the objects whose destruction may take too long, so that it is destroyed after them.
class ExitDeadline {
public:
    ExitDeadline() = default;
    ~ExitDeadline();
    ExitDeadline(const ExitDeadline&) = delete;
    ExitDeadline& operator=(const ExitDeadline&) = delete;

    /// The process ends after this time, counted from now, unless the object is destroyed before. Call it once.
    void start(std::chrono::milliseconds time);

private:
    std::mutex mutex_;
    std::condition_variable met_;
    bool is_met_ = false;
    std::thread watching_;
};

}  // namespace meniscus::server
