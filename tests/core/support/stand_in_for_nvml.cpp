// In the place of the driver's management library: a GPU of 80 GiB, 20 of them taken, and one that refuses to answer.
#include <cstring>

namespace {

struct Memory {
    unsigned long long total, free, used;
};
int starts = 0;
int whole_gpu, refusing_gpu;
constexpr int success = 0, not_found = 6, no_permission = 4;

}  // namespace

extern "C" {

int nvmlInit_v2() {
    ++starts;
    return success;
}

int nvmlDeviceGetHandleByPciBusId_v2(const char* bus_id, void** device) {
    if (starts != 1) return not_found;
    if (std::strcmp(bus_id, "0000:3b:00.0") == 0)
        *device = &whole_gpu;
    else if (std::strcmp(bus_id, "0000:5e:00.0") == 0)
        *device = &refusing_gpu;
    else
        return not_found;
    return success;
}

int nvmlDeviceGetMemoryInfo(void* device, Memory* memory) {
    if (device != &whole_gpu) return no_permission;
    constexpr unsigned long long gib = 1ULL << 30;
    *memory = {80 * gib, 60 * gib, 20 * gib};
    return success;
}
}
