#include "gpu/rounding.hpp"

#include "engine/cuda/warp.hpp"
#include "field/lanes.hpp"

namespace meniscus::benchmarks {
namespace {

/// With the functions that the backend's kernels use.
__global__ void __launch_bounds__(cuda::block_threads)
    compute(Operation operation, std::uint64_t first, std::uint64_t n, std::uint64_t count, float* out) {
    cuda::GridLoop{}.each(n, [&](std::uint32_t i) {
        const Arguments x = arguments(operation, first + i, count);
        float result = 0.0F;
        switch (operation) {
            case Operation::root:
                result = sqrt(x.a);
                break;
            case Operation::reciprocal:
                result = 1.0F / x.a;
                break;
            case Operation::quotient:
                result = x.a / x.b;
                break;
            case Operation::fused:
                result = fma(x.a, x.b, x.c);
                break;
        }
        out[i] = result;
    });
}

}  // namespace

void compute_on_device(Operation operation, std::uint64_t first, std::uint64_t n, std::uint64_t count, float* out,
                       const cuda::Launcher& launch) {
    launch(n, cuda::block_threads, compute, operation, first, n, count, out);
}

}  // namespace meniscus::benchmarks
