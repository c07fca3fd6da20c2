// The GPUs that can be used, and the reason where one cannot.
#include "engine/cuda/device.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "engine/cuda/driver_memory.hpp"
#include "engine/cuda/errors.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cuda {
namespace {

std::string version(int number) {
    return std::to_string(number / 1000) + "." + std::to_string(number % 1000 / 10);
}

/// CUDA has one error for a missing driver and for an old one.
std::string why_no_driver() {
    int found = 0;
    if (cudaDriverGetVersion(&found) != cudaSuccess || found == 0) return "no NVIDIA driver found";
    return "the NVIDIA driver is for CUDA " + version(found) + ", must be for " + version(CUDART_VERSION) + " or newer";
}

/// Number of devices; 0 and the reason if there is none.
int device_count(std::string& reason) {
    int count = 0;
    const cudaError_t status = cudaGetDeviceCount(&count);
    // Without a driver the call fails and leaves its error behind.
    cudaGetLastError();
    if (status == cudaErrorInsufficientDriver)
        reason = why_no_driver();
    else if (status != cudaSuccess && status != cudaErrorNoDevice)
        reason = std::string("no usable GPU (") + cudaGetErrorString(status) + ")";
    else if (count == 0)
        reason = "no GPU found";
    return status == cudaSuccess ? count : 0;
}

int attribute(cudaDeviceAttr which, int device) {
    int value = 0;
    check(cudaDeviceGetAttribute(&value, which, device), "cudaDeviceGetAttribute");
    return value;
}

int capability(int device) {
    return 10 * attribute(cudaDevAttrComputeCapabilityMajor, device) +
           attribute(cudaDevAttrComputeCapabilityMinor, device);
}

/// The answer of CUDA, which starts on the device if it has not yet.
void read_memory(Device& device) {
    const CurrentDevice current(device.index);
    check(cudaMemGetInfo(&device.free_bytes, &device.total_bytes), "cudaMemGetInfo");
}

Device describe(int index) {
    cudaDeviceProp properties{};
    check(cudaGetDeviceProperties(&properties, index), "cudaGetDeviceProperties");
    Device device{index, properties.name, capability(index), 0, properties.totalGlobalMem};
    char bus_id[32] = {};
    check(cudaDeviceGetPCIBusId(bus_id, sizeof bus_id, index), "cudaDeviceGetPCIBusId");
    const std::optional<DriverMemory> memory = is_started(index) ? std::nullopt : driver_memory(bus_id);
    // A part of a GPU (MIG) has the whole one's place on the bus, and less memory.
    if (memory && memory->total_bytes / 5 * 4 <= device.total_bytes)
        device.free_bytes = std::min(memory->free_bytes, device.total_bytes);
    else
        read_memory(device);
    return device;
}

}  // namespace

std::vector<Device> devices(std::span<const int> among) {
    std::vector<Device> result;
    std::string reason;
    const int count = device_count(reason);
    for (int i = 0; i < count; ++i) {
        if (!among.empty() && std::ranges::find(among, i) == among.end()) continue;
        try {
            if (why_unavailable(i).empty()) result.push_back(describe(i));
        } catch (const std::runtime_error&) {
            // Failed earlier in this process, or cannot be asked: the others may still do.
        }
    }
    return result;
}

bool answers(int device) try {
    Device asked{.index = device, .name = {}};
    read_memory(asked);
    return true;
} catch (const std::runtime_error&) {
    return false;
}

std::string why_unavailable(int device) try {
    std::string reason;
    const int count = device_count(reason);
    if (count == 0) return reason;
    if (device < 0 || device >= count)
        return "no GPU " + std::to_string(device) + ": there are 0 to " + std::to_string(count - 1);
    const int found = capability(device);
    if (found < oldest_capability)
        return device_name(device) + " has compute capability " + std::to_string(found / 10) + "." +
               std::to_string(found % 10) + ", must be " + std::to_string(oldest_capability / 10) + "." +
               std::to_string(oldest_capability % 10) + " or newer";
    if (attribute(cudaDevAttrMemoryPoolsSupported, device) == 0) return device_name(device) + " has no memory pools";
    if (attribute(cudaDevAttrCooperativeLaunch, device) == 0)
        return device_name(device) + " has no cooperative launches";
    return {};
} catch (const DeviceError& error) {
    return error.what();
}

std::string device_name(int device) {
    cudaDeviceProp properties{};
    check(cudaGetDeviceProperties(&properties, device), "cudaGetDeviceProperties");
    return properties.name;
}

}  // namespace meniscus::cuda
