// Whether a GPU can reconstruct here.
#pragma once

#include <string>

#include "meniscus/devices.hpp"

namespace meniscus::cuda {

/// The reason why a device cannot be used, in one line; empty if it can. Does not start CUDA on the device.
std::string why_unavailable(int device);

/// The device's name, in words.
std::string device_name(int device);

}  // namespace meniscus::cuda
