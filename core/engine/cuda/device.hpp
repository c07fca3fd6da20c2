// Whether a GPU can reconstruct here.
#pragma once

#include <string>

#include "meniscus/devices.hpp"

namespace meniscus::cuda {

/// In one line, why a device cannot be used; empty if it can. Does not start CUDA on the device.
std::string why_unavailable(int device);

/// Its name, in words.
std::string device_name(int device);

}  // namespace meniscus::cuda
