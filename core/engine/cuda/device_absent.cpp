// A build without CUDA has no GPU.
#include "engine/cuda/device.hpp"

namespace meniscus::cuda {

std::vector<Device> devices(std::span<const int>) {
    return {};
}

bool answers(int) {
    return false;
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): as where there are devices
std::shared_ptr<PagePinning> page_pinning(int, std::function<void(const std::string& reason)>) {
    return nullptr;
}

std::string why_unavailable(int) {
    return "this build has no CUDA backend";
}

std::string device_name(int) {
    return "no GPU";
}

}  // namespace meniscus::cuda
