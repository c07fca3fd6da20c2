#include "sessions/session/placement.hpp"

#include <algorithm>
#include <functional>

#include "sessions/limits/refusal.hpp"

namespace meniscus::server {

BackendOptions place_on(BackendOptions backend, std::vector<cuda::Device> devices, const Answers& answers) {
    std::ranges::stable_sort(devices, std::ranges::greater{}, &cuda::Device::free_bytes);
    const auto place = std::ranges::find_if(devices, answers, &cuda::Device::index);
    if (place != devices.end()) {
        backend.backend = Backend::cuda;
        backend.device = place->index;
        return backend;
    }
    if (backend.backend == Backend::cuda)
        throw Refusal(Refusal::Kind::unavailable, "no GPU answers, and the server may not use the CPU instead");
    backend.backend = Backend::cpu;
    return backend;
}

}  // namespace meniscus::server
