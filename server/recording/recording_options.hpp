// What is recorded, where, and how much.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace meniscus::server {

struct RecordingOptions {
    std::filesystem::path directory;  ///< empty: nothing is recorded
    std::uint64_t limit = 0;          ///< bytes of all recordings in it, earlier ones included; 0: no limit
    /// Frames that wait for the disk, bytes over all sessions. Further ones are left out of their recordings.
    std::size_t waiting_limit = std::size_t{256} << 20;
};

/// Throws InvalidInput if the directory is not one that can be written to, or made. Makes nothing.
void require_recordable(const RecordingOptions& options);

}  // namespace meniscus::server
