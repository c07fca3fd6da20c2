#include "gpu/full_queue.hpp"

namespace meniscus::benchmarks {
namespace {

__global__ void spin(long long clocks) {
    const long long begin = clock64();
    while (clock64() - begin < clocks) {
    }
}

}  // namespace

void keep_busy(cudaStream_t stream) {
    constexpr long long two_milliseconds = 4'000'000;  // at up to 2 GHz
    cudaLaunchConfig_t configuration{};
    configuration.gridDim = dim3(1);
    configuration.blockDim = dim3(32);
    configuration.stream = stream;
    cuda::check(cudaLaunchKernelEx(&configuration, spin, two_milliseconds), "cudaLaunchKernelEx");
}

}  // namespace meniscus::benchmarks
