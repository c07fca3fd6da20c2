// One uploading stream, as its session sees it.
#pragma once

#include <functional>
#include <utility>

#include "sessions/output_queue.hpp"

namespace meniscus::server {

struct UploadOptions {
    bool receive_meshes = false;
    int normal_bits = 0;
};

struct Upload {
    /// wake: as OutputQueue has it. stop_receiving: called when the session is to take no further frame than the one on its way in.
    Upload(const UploadOptions& wishes, std::function<void()> wake, std::function<void()> stop_receiving)
        : options(wishes), output(std::move(wake)), drain(std::move(stop_receiving)) {}

    const UploadOptions options;
    OutputQueue output;
    const std::function<void()> drain;
};

}  // namespace meniscus::server
