// What tests ask of the software device's copies and of memory that it pins, and tell them.
#pragma once

#include <cstddef>
#include <functional>

#include "cuda_runtime.h"

namespace emulated_device {

/// Called, if there, for every copy as it is asked for; what it answers is the copy's status.
extern std::function<cudaError_t(const void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind)> on_copy;
/// What cudaHostRegister answers.
extern cudaError_t register_status;
/// What cudaHostUnregister answers, which does nothing then unless it is cudaSuccess.
extern cudaError_t unregister_status;

}  // namespace emulated_device
