// Starts threads, of which there may be too many.
#pragma once

#include <fmt/format.h>

#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "meniscus/error.hpp"

namespace meniscus::server {

/// name: what the thread does, as "that encodes the meshes of session ...". Throws LimitExceeded, with this name, if
/// the system starts no more threads.
template <class Work>
std::thread start_thread(std::string_view name, Work work) {
    try {
        return std::thread(std::move(work));
    } catch (const std::system_error& error) {
        throw LimitExceeded(
            fmt::format("the server cannot start the thread {}: {}; it needs a higher limit of threads (ulimit -u, "
                        "TasksMax of systemd, pids of a container) or fewer sessions",
                        name, error.code().message()));
    }
}

}  // namespace meniscus::server
