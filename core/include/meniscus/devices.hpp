// The GPUs of this machine.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace meniscus::cuda {

/// Oldest compute capability that the CUDA backend is compiled for, times ten.
inline constexpr int oldest_capability = 80;

struct Device {
    int index = 0;  ///< for BackendOptions::device
    std::string name;
    int capability = 0;          ///< compute capability times ten: 90 for 9.0
    std::size_t free_bytes = 0;  ///< now; reading it starts CUDA on the device, which takes some of its memory
    std::size_t total_bytes = 0;
};

/// The devices that can reconstruct and answer now. among: indices of the devices to ask, all if empty. Without a
/// driver, and in a build without CUDA, there are none.
std::vector<Device> devices(std::span<const int> among = {});

}  // namespace meniscus::cuda
