// A build without CUDA cannot reconstruct on a GPU.
#include "engine/cuda/device.hpp"
#include "meniscus/error.hpp"
#include "pipeline/backend.hpp"

namespace meniscus::cuda {

std::unique_ptr<BackendReconstruction> make_reconstruction(const Settings&, const BackendOptions& options,
                                                           const std::shared_ptr<MemoryAccount>&,
                                                           const std::shared_ptr<MemoryAccount>&) {
    throw InvalidInput("the CUDA backend cannot be used: " + why_unavailable(options.device));
}

}  // namespace meniscus::cuda
