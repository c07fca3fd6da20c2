// Ctrl-C, and other signals that end the process, where something is to be ended first.
#pragma once

#include <array>
#include <csignal>
#include <functional>
#include <thread>

namespace meniscus::cli {

/// While it is there, SIGINT, SIGTERM and SIGHUP first have before_end called, on a thread of its own and for 0.6 s at
/// most, then end the process as they always do. A second one of the same kind ends it at once. A signal that the
/// process ignores stays ignored. There is one at a time.
class Interrupts {
public:
    /// before_end throws nothing. What it refers to outlives this object.
    explicit Interrupts(std::function<void()> before_end);
    ~Interrupts();
    Interrupts(const Interrupts&) = delete;
    Interrupts& operator=(const Interrupts&) = delete;

private:
    void wait_for_signal();

    const std::function<void()> before_end_;
    std::array<struct sigaction, 3> before_{};
    std::array<int, 2> pipe_{};
    std::thread thread_;
};

}  // namespace meniscus::cli
