#include "sessions/placement.hpp"

#include <algorithm>

#include "sessions/refusal.hpp"

namespace meniscus::server {

BackendOptions place_on(BackendOptions backend, std::span<const cuda::Device> devices) {
    const auto freest = std::ranges::max_element(devices, {}, &cuda::Device::free_bytes);
    if (freest != devices.end()) {
        backend.backend = Backend::cuda;
        backend.device = freest->index;
        return backend;
    }
    if (backend.backend == Backend::cuda)
        throw Refusal(Refusal::Kind::unavailable, "no GPU answers, and the server may not use the CPU instead");
    backend.backend = Backend::cpu;
    return backend;
}

}  // namespace meniscus::server
