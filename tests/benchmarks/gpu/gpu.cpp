#include "gpu/gpu.hpp"

#include "engine/cuda/device.hpp"

namespace meniscus::benchmarks {

void require_gpu() {
    if (const std::string why = cuda::why_unavailable(0); !why.empty()) throw NoGpu("there is no GPU to use: " + why);
}

}  // namespace meniscus::benchmarks
