// Loops of kernels that may take long ask whether the host wants the frame to stop.
#pragma once

#include "engine/cuda/state.hpp"
#include "engine/cuda/warp.hpp"

namespace meniscus::cuda {

/// A thread's side of a long loop. The flag lies in the host's memory, where reading it costs microseconds: the grid's
/// first thread reads it as it begins, which is in time for kernels that take little, and all read it every few
/// milliseconds after that. A thread that finds it raised sets Counts::stop, so that no later kernel finds anything to
/// do.
class LongLoop {
public:
    __device__ explicit LongLoop(const State& state) : state_(state), asked_at_(clock_now()) {
        if (blockIdx.x == 0 && threadIdx.x == 0) asked_at_ -= clocks_between;
    }

    /// Asked before every element: whether to go on with it.
    __device__ bool goes_on() {
        if (state_.stop_word == nullptr) return true;
        const unsigned now = clock_now();
        if (now - asked_at_ < clocks_between) return true;
        if (*state_.stop_word == 0) {
            asked_at_ = now;
            return true;
        }
        state_.counts->stop = Stop::asked_for;
        return false;
    }
    /// The same for all lanes of a warp, which ask together.
    __device__ bool goes_on_together() { return same_in_all_lanes(lane_index() == 0 && !goes_on() ? 1 : 0) == 0; }

private:
    static constexpr unsigned clocks_between = 1U << 23;  ///< some milliseconds

    __device__ static unsigned clock_now() { return static_cast<unsigned>(clock64()); }

    const State& state_;
    unsigned asked_at_;
};

}  // namespace meniscus::cuda
