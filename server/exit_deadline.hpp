// Ends the process at the end of its grace period, whatever still runs: a reconstruction cannot be interrupted.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace meniscus::server {

/// Made before what may take too long, so that it goes after that.
class ExitDeadline {
public:
    ExitDeadline() = default;
    ~ExitDeadline();
    ExitDeadline(const ExitDeadline&) = delete;
    ExitDeadline& operator=(const ExitDeadline&) = delete;

    /// From now the process has so long; once.
    void start(std::chrono::milliseconds time);

private:
    std::mutex mutex_;
    std::condition_variable met_;
    bool is_met_ = false;
    std::thread watching_;
};

}  // namespace meniscus::server
