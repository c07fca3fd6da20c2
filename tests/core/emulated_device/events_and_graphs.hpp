// Questions and orders of tests to the software device's events and graphs.
#pragma once

#include <cstddef>

#include "cuda_runtime.h"

namespace emulated_device {

/// Number of graphs that were launched in this process.
extern std::size_t graph_launches;
/// The answer of cudaGraphInstantiate.
extern cudaError_t instantiate_status;
/// The answer of cudaEventElapsedTime.
extern cudaError_t elapsed_time_status;

}  // namespace emulated_device
