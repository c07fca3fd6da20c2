// A build without CUDA has no GPU.
#include "engine/cuda/device.hpp"
#include "meniscus/error.hpp"
#include "pipeline/backend.hpp"

namespace meniscus::cuda {

std::vector<Device> devices(std::span<const int>) {
    return {};
}

std::string why_unavailable(int) {
    return "this build has no CUDA backend";
}

std::string device_name(int) {
    return "no GPU";
}

std::unique_ptr<BackendReconstruction> make_reconstruction(const Settings&, int device,
                                                           const std::shared_ptr<MemoryAccount>&,
                                                           const std::shared_ptr<MemoryAccount>&) {
    throw InvalidInput("the CUDA backend cannot be used: " + why_unavailable(device));
}

}  // namespace meniscus::cuda
