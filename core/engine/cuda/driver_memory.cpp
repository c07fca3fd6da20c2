#include "engine/cuda/driver_memory.hpp"

#include <dlfcn.h>

#include <map>
#include <mutex>
#include <type_traits>

namespace meniscus::cuda {
namespace {

// The part of nvml.h that is needed: Debian has no package of that header, and its functions have kept this form.
using NvmlDevice = struct NvmlDeviceState*;
struct NvmlMemory {
    unsigned long long total, free, used;
};
constexpr int nvml_success = 0;

/// The library's functions; none where it is missing or does not start.
struct Nvml {
    int (*init)() = nullptr;
    int (*device_at)(const char* bus_id, NvmlDevice* device) = nullptr;
    int (*memory_of)(NvmlDevice device, NvmlMemory* memory) = nullptr;
    bool works = false;

    explicit Nvml(const char* name) {
        void* const library = dlopen(name, RTLD_NOW | RTLD_LOCAL);
        if (library == nullptr) return;
        const auto find = [&](const char* symbol, auto& function) {
            function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library, symbol));
            return function != nullptr;
        };
        works = find("nvmlInit_v2", init) && find("nvmlDeviceGetHandleByPciBusId_v2", device_at) &&
                find("nvmlDeviceGetMemoryInfo", memory_of) && init() == nvml_success;
    }
};

}  // namespace

std::optional<DriverMemory> driver_memory(const std::string& bus_id, const char* library) {
    static std::mutex mutex;
    static std::map<std::string, Nvml> libraries;
    const std::lock_guard lock(mutex);
    const Nvml& nvml = libraries.try_emplace(library, library).first->second;
    NvmlDevice device = nullptr;
    NvmlMemory memory{};
    if (!nvml.works || nvml.device_at(bus_id.c_str(), &device) != nvml_success ||
        nvml.memory_of(device, &memory) != nvml_success)
        return std::nullopt;
    return DriverMemory{static_cast<std::size_t>(memory.free), static_cast<std::size_t>(memory.total)};
}

}  // namespace meniscus::cuda
