// On which GPU a new session reconstructs.
#pragma once

#include <functional>
#include <vector>

#include "meniscus/backend_options.hpp"
#include "meniscus/devices.hpp"

namespace meniscus::server {

/// Whether CUDA works on a device, which may start it there.
using Answers = std::function<bool(int device)>;

/// On the device with the most free memory that answers, the first of equals; no other is asked. Without one: on the
/// CPU, where the backend may be chosen; where CUDA was asked for, throws Refusal.
BackendOptions place_on(BackendOptions backend, std::vector<cuda::Device> devices, const Answers& answers);

}  // namespace meniscus::server
