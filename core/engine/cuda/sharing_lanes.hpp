// Lanes that share a particle. A frame of few particles waits for its slowest thread, and has threads to spare.
#pragma once

#include <cstdint>

#include "engine/cuda/state.hpp"
#include "engine/cuda/warp.hpp"

namespace meniscus::cuda {

/// Of each particle, where the grid has_threads_to_spare(): a power of two.
inline constexpr unsigned lanes_to_share = 4;

__device__ inline bool has_threads_to_spare(std::uint32_t particles) {
    return std::uint64_t{lanes_to_share} * particles <= GridLoop{}.step;
}

/// Those of one particle, as each of them sees them.
template <unsigned count>
struct SharingLanes {
    unsigned own = lane_index() % count;

    /// The value of the i-th of them, which all of them ask for.
    template <class Value>
    __device__ Value from(Value value, unsigned i) const {
        if constexpr (count == 1) return value;
        const unsigned first = lane_index() - own;
        return __shfl_sync(((1U << count) - 1) << first, value, static_cast<int>(first + i));
    }
};

}  // namespace meniscus::cuda
