// Processor time, which other programs on the machine add little to.
#pragma once

#include <ctime>
#include <stdexcept>

namespace meniscus::benchmarks {

/// Seconds of a clock of processor time, since its thread or process began.
inline double clock_seconds(clockid_t clock) {
    std::timespec time{};
    if (clock_gettime(clock, &time) != 0) throw std::runtime_error("no processor time to be had of a process");
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Of the calling thread.
inline double thread_seconds() {
    return clock_seconds(CLOCK_THREAD_CPUTIME_ID);
}

}  // namespace meniscus::benchmarks
