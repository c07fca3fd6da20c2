// Processor time of one thread, which other programs on the machine add little to.
#pragma once

#include <ctime>

namespace meniscus::benchmarks {

/// Of the calling thread, since it began.
inline double thread_seconds() {
    std::timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace meniscus::benchmarks
