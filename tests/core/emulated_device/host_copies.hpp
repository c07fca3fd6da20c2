// Questions and orders of tests to the software device's copies and the memory that it pins.
#pragma once

#include <cstddef>
#include <functional>

#include "cuda_runtime.h"

namespace emulated_device {

/// Called, if set, for every copy as it is asked for; its answer is the copy's status.
extern std::function<cudaError_t(const void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind)> on_copy;
/// The answer of cudaHostRegister.
extern cudaError_t register_status;
/// The answer of cudaHostUnregister, which does nothing unless it is cudaSuccess.
extern cudaError_t unregister_status;

}  // namespace emulated_device
