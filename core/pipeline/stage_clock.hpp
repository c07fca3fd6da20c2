// The time that the CPU spends in each of the paper's steps.
#pragma once

#include <chrono>
#include <cstddef>

#include "meniscus/statistics.hpp"

namespace meniscus {

/// Charges the time until the next call, or its own end, to a stage.
class StageClock {
public:
    explicit StageClock(Statistics& statistics) : statistics_(statistics) {}
    ~StageClock() { stop(); }
    StageClock(const StageClock&) = delete;
    StageClock& operator=(const StageClock&) = delete;

    void enter(Stage stage) {
        stop();
        stage_ = stage;
        running_ = true;
        start_ = Clock::now();
    }

private:
    using Clock = std::chrono::steady_clock;
    void stop() {
        if (running_)
            statistics_.stage_seconds[static_cast<std::size_t>(stage_)] +=
                std::chrono::duration<double>(Clock::now() - start_).count();
        running_ = false;
    }

    Statistics& statistics_;
    Stage stage_{};
    bool running_ = false;
    Clock::time_point start_;
};

/// A clock for calls whose times are not asked for.
struct NoClock {
    void enter(Stage) {}
};

}  // namespace meniscus
