// CUDA's error codes as exceptions.
#include "engine/cuda/errors.hpp"

#include <string>

#include "meniscus/error.hpp"

namespace meniscus::cuda {

bool is_started(int device) {
    // Only the driver's API knows.
    using StateOf = int (*)(int device, unsigned* flags, int* active);  // cuDevicePrimaryCtxGetState
    void* state_of = nullptr;
    cudaDriverEntryPointQueryResult found{};
    cudaGetDriverEntryPointByVersion("cuDevicePrimaryCtxGetState", &state_of, 7000, cudaEnableDefault, &found);
    unsigned flags = 0;
    int active = 0;
    if (state_of != nullptr) reinterpret_cast<StateOf>(state_of)(device, &flags, &active);
    return active != 0;
}

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

CurrentDevice::CurrentDevice(int device) {
    // CUB takes an error that an earlier call has left behind in this thread for its own.
    cudaGetLastError();
    check(cudaGetDevice(&before_), "cudaGetDevice");
    check(cudaSetDevice(device), "cudaSetDevice");
    returns_ = before_ != device && is_started(before_);
}

CurrentDevice::~CurrentDevice() {
    if (returns_) cudaSetDevice(before_);
}

}  // namespace meniscus::cuda
