#include "kernel_times.hpp"
#include "meniscus/error.hpp"

namespace meniscus::benchmarks {

void print_kernel_times(const ParticleFrame&, const Settings&, unsigned) {
    throw InvalidInput("--kernels: this build has no CUDA backend; configure it where nvcc is");
}

}  // namespace meniscus::benchmarks
