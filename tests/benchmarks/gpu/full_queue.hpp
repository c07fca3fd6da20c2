// A queue that stays full: what a GPU does behind it begins as soon as what comes before has ended, however slowly the
// host has launched it.
#pragma once

#include "engine/cuda/errors.hpp"

namespace meniscus::benchmarks {

/// Keeps the stream busy for some 2 ms, in which the host launches a frame's kernels.
void keep_busy(cudaStream_t stream);

}  // namespace meniscus::benchmarks
