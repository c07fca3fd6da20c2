#include "backends/cuda/errors.hpp"

#include <string>

#include "meniscus/error.hpp"

namespace meniscus::cuda {

void check(cudaError_t status, const char* call) {
    if (status == cudaSuccess) return;
    int device = 0;
    cudaGetDevice(&device);
    // An error that does not stick to the device would else be met again by the next call that asks for one.
    cudaGetLastError();
    if (status == cudaErrorMemoryAllocation)
        throw LimitExceeded("CUDA device " + std::to_string(device) + " has not enough memory left (" + call +
                            "): use a larger cell size, fewer particles or another device");
    throw DeviceError(call, cudaGetErrorString(status), device);
}

}  // namespace meniscus::cuda
