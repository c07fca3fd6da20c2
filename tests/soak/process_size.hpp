// The memory and descriptors of a process, from Linux.
#pragma once

#include <sys/types.h>

#include <cstddef>

namespace meniscus::soak {

struct ProcessSize {
    std::size_t memory_bytes = 0;  ///< resident and its own: no files, no shared memory
    std::size_t descriptors = 0;
};

/// Throws std::runtime_error if there is no such process or it is somebody else's.
ProcessSize process_size(pid_t process);

}  // namespace meniscus::soak
