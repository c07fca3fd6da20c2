// Failed calls to CUDA as exceptions.
#pragma once

#include <cuda_runtime.h>

namespace meniscus::cuda {

/// Throws LimitExceeded if the device has no memory left, DeviceError for any other failure of the call named.
void check(cudaError_t status, const char* call);

/// Whether this process has started CUDA on a device.
bool is_started(int device);

/// Makes a device current in this thread, and the one before again at the end if CUDA runs there: else cudaSetDevice
/// would start it, which takes some hundred megabytes of a GPU that this process may not even be meant to use.
class CurrentDevice {
public:
    explicit CurrentDevice(int device);
    ~CurrentDevice();
    CurrentDevice(const CurrentDevice&) = delete;
    CurrentDevice& operator=(const CurrentDevice&) = delete;

private:
    int before_ = 0;
    bool returns_ = false;
};

}  // namespace meniscus::cuda
