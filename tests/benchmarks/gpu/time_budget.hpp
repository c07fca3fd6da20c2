// The time that a command may take, from its begin on.
#pragma once

#include <chrono>

namespace meniscus::benchmarks {

class TimeBudget {
public:
    /// seconds: 0 for no limit.
    explicit TimeBudget(double seconds) : seconds_(seconds) {}

    double elapsed() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }
    /// Whether `more` seconds fit.
    bool allows(double more) const { return seconds_ <= 0.0 || elapsed() + more < seconds_; }

private:
    using Clock = std::chrono::steady_clock;
    double seconds_;
    Clock::time_point begin_ = Clock::now();
};

}  // namespace meniscus::benchmarks
