#include "backends/cuda/device.hpp"

namespace meniscus::cuda {

std::string why_unavailable() { return "this build has no CUDA backend"; }

}  // namespace meniscus::cuda
