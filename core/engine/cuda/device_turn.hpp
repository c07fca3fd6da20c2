// The frames of one process take turns on a device.
#pragma once

#include <map>
#include <mutex>

namespace meniscus::cuda {

/// Held by a frame from its first kernel to its last. The blocks of a cooperative grid wait for each other: of two such
/// grids that fill the device together, each might have begun a part of its blocks alone.
inline std::mutex& turn_on(int device) {
    static std::mutex mutex;
    static std::map<int, std::mutex> turns;
    const std::lock_guard lock(mutex);
    return turns[device];
}

}  // namespace meniscus::cuda
