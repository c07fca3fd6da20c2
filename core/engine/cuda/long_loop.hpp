// Loops of kernels that may take long ask whether the host wants the frame to stop.
#pragma once

#include "engine/cuda/state.hpp"
#include "engine/cuda/warp.hpp"

namespace meniscus::cuda {

/// A thread's side of a long loop. The flag lies in the host's memory, where reading it costs microseconds: a frame
/// reads it once, see stop_where_asked(), and threads of kernels that take longer every few milliseconds. A thread that
/// finds it raised sets Counts::stop, so that no later kernel finds anything to do.
class LongLoop {
public:
    __device__ explicit LongLoop(const State& state) : state_(state), asked_at_(clock_now()) {}

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

/// By the one thread of a kernel.
__device__ inline void stop_where_asked(const State& state) {
    if (state.stop_word != nullptr && *state.stop_word != 0) state.counts->stop = Stop::asked_for;
}

}  // namespace meniscus::cuda
