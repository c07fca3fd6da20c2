// How the backend runs where faults are looked for: chosen by the environment, for a GPU and for tests without one.
#pragma once

#include <cstdint>

namespace meniscus::cuda {

/// The places of a reconstruction's arrays in device memory. MENISCUS_DEVICE_ARRAYS names one.
enum class ArrayPlacement : std::uint8_t {
    together,  ///< all in one allocation: the default
    guarded,   ///< each in an allocation of its own, poisoned before every frame, between guards that are checked after
               ///< it
    separate,  ///< each in an allocation of its own that only kernels and copies write, for tools that watch memory
};
/// The environment's choice. Throws InvalidInput for a name that is none of these.
ArrayPlacement array_placement();

/// Whether frames that have passed without growth are replayed as graphs: not where MENISCUS_NO_GRAPH is 1. Throws
/// InvalidInput for what is neither 0 nor 1.
bool uses_graphs();

/// The most blocks of a kernel that waits for its whole grid: MENISCUS_COOPERATIVE_BLOCKS; with 1 no block waits for
/// another, which tells whether one that hangs does. 0 where the variable is unset: as many as run at once. Throws
/// InvalidInput for a text that is no number from 1 on.
unsigned most_cooperative_blocks();

}  // namespace meniscus::cuda
