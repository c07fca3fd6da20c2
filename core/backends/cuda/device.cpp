#include "backends/cuda/device.hpp"

#include <cuda_runtime_api.h>

namespace meniscus::cuda {

std::string why_unavailable() {
    int count = 0;
    const cudaError_t status = cudaGetDeviceCount(&count);
    // Without a driver the call fails and leaves its error behind.
    cudaGetLastError();
    if (status != cudaSuccess) return std::string("no usable GPU (") + cudaGetErrorString(status) + ")";
    if (count == 0) return "no GPU";
    return "this version reconstructs on the CPU only";
}

}  // namespace meniscus::cuda
