// Failed calls to CUDA as exceptions.
#pragma once

#include <cuda_runtime.h>

namespace meniscus::cuda {

/// Throws LimitExceeded if the device has no memory left, DeviceError for any other failure of the call named.
void check(cudaError_t status, const char* call);

/// Makes a device current in this thread, and the one before again at the end.
class CurrentDevice {
public:
    explicit CurrentDevice(int device) {
        check(cudaGetDevice(&before_), "cudaGetDevice");
        check(cudaSetDevice(device), "cudaSetDevice");
    }
    ~CurrentDevice() { cudaSetDevice(before_); }
    CurrentDevice(const CurrentDevice&) = delete;
    CurrentDevice& operator=(const CurrentDevice&) = delete;

private:
    int before_ = 0;
};

}  // namespace meniscus::cuda
