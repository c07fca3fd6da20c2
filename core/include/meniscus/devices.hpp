// The GPUs of this machine.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "meniscus/memory.hpp"

namespace meniscus::cuda {

/// Oldest compute capability that the CUDA backend is compiled for, times ten.
inline constexpr int oldest_capability = 80;

struct Device {
    int index = 0;  ///< index for BackendOptions::device
    std::string name;
    int capability = 0;          ///< compute capability times ten: 90 for 9.0
    std::size_t free_bytes = 0;  ///< free memory, now and for all programs on it
    std::size_t total_bytes = 0;
};

/// The devices that can reconstruct and have not failed in this process. among: indices of the devices to ask, all if
/// empty. Without a driver, and in a build without CUDA, there are none. Starts CUDA on a device, which takes some
/// hundred megabytes of its memory, only where the driver's management library does not give the free memory.
std::vector<Device> devices(std::span<const int> among = {});

/// Whether CUDA works on a device now. Starts it there.
bool answers(int device);

/// Pins memory for a GPU's copies, see ParticleFrame; starts CUDA on it at the first array. on_refusal: called once,
/// with the reason, where memory cannot be pinned; may be empty, and throws nothing. In a build without CUDA it pins
/// nothing.
std::shared_ptr<PagePinning> page_pinning(int device, std::function<void(const std::string& reason)> on_refusal = {});

}  // namespace meniscus::cuda
