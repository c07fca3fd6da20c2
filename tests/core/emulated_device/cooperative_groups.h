// See cuda_runtime.h.
#pragma once

#include "cuda_runtime.h"

namespace cooperative_groups {
struct Grid {
    void sync(emulated_device::Place place = emulated_device::Place::current()) const {
        emulated_device::wait_for_grid(place);
    }
};
inline Grid this_grid() {
    return {};
}
}  // namespace cooperative_groups
