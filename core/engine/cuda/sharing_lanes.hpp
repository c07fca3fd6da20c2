// Lanes that share a particle. A frame of few particles waits for its slowest thread, and leaves threads idle.
#pragma once

#include <cstdint>

#include "engine/cuda/launch.hpp"
#include "engine/cuda/state.hpp"
#include "engine/cuda/warp.hpp"

namespace meniscus::cuda {

/// Number of lanes that share a particle: a power of two.
inline constexpr unsigned lanes_to_share = 4;

/// The lanes of one particle, as each of them sees them. count: 1 or lanes_to_share.
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

/// Launches a kernel for all particles: `shared`, whose lanes share particles, if the device runs that number of
/// threads at once, else `alone`, with a thread for each particle.
inline void launch_for_particles(const State& state, const Launcher& launch, void (*shared)(State),
                                 void (*alone)(State)) {
    const std::uint64_t particles = state.capacity.particles;
    if (lanes_to_share * particles <= launch.threads_at_once(shared))
        launch(particles, block_threads / lanes_to_share, shared, state);
    else
        launch(particles, block_threads, alone, state);
}

}  // namespace meniscus::cuda
