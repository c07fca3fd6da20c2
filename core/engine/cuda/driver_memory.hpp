// A GPU's memory by the driver's management library (NVML): it starts nothing on the GPU, where CUDA would take some
// hundred megabytes.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace meniscus::cuda {

struct DriverMemory {
    std::size_t free_bytes = 0;
    std::size_t total_bytes = 0;
};

inline constexpr const char* driver_library = "libnvidia-ml.so.1";  ///< comes with the driver

/// The memory of the GPU at a place on the PCI bus, such as "0000:3b:00.0". None where the library is missing, as in
/// containers without the driver capability "utility", or gives no answer. A library is loaded once, and stays.
/// Thread-safe.
std::optional<DriverMemory> driver_memory(const std::string& bus_id, const char* library = driver_library);

}  // namespace meniscus::cuda
