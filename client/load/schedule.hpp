// The time at which each frame is due, whatever became of the frames before it.
#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>

namespace meniscus::load {

using Clock = std::chrono::steady_clock;

inline double seconds_between(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
}

/// An open loop: a frame that is late does not delay those after it, and every latency counts from the time at which
/// the frame was due, so that a server that stalls cannot hide it by holding up its clients.
struct Schedule {
    Clock::time_point start;
    double frames_per_second = 0.0;
    std::uint64_t frames = 0;
    std::uint64_t warm_up_frames = 0;  ///< the first frames, which are sent but not measured

    Clock::time_point due(std::uint64_t frame) const {
        const std::chrono::duration<double> since_start(static_cast<double>(frame) / frames_per_second);
        return start + std::chrono::duration_cast<Clock::duration>(since_start);
    }
    bool measured(std::uint64_t frame) const { return frame >= warm_up_frames; }
};

}  // namespace meniscus::load
