// On which GPU a new session reconstructs.
#pragma once

#include <span>

#include "meniscus/backend_options.hpp"
#include "meniscus/devices.hpp"

namespace meniscus::server {

/// On the device with the most free memory, the first of equals. Without devices: on the CPU, where the backend may be
/// chosen; where CUDA was asked for, throws Refusal.
BackendOptions place_on(BackendOptions backend, std::span<const cuda::Device> devices);

}  // namespace meniscus::server
