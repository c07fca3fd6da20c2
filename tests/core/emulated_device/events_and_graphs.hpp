// What tests ask of the software device's events and graphs, and tell them.
#pragma once

#include <cstddef>

#include "cuda_runtime.h"

namespace emulated_device {

/// How many graphs were launched in this process.
extern std::size_t graph_launches;
/// What cudaEventElapsedTime answers.
extern cudaError_t elapsed_time_status;

}  // namespace emulated_device
