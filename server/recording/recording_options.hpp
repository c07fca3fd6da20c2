// What is recorded, where, and how much.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "meniscus/attribute_coding.hpp"

namespace meniscus::server {

/// Which recordings go by themselves, none that is being written or read.
struct RecordingRetention {
    std::uint64_t min_frames = 0;         ///< those of fewer frames, once they are closed; 0: none
    std::chrono::milliseconds max_age{};  ///< those that were last written so long ago; 0: none

    bool keeps_all() const noexcept { return min_frames == 0 && max_age.count() == 0; }
};

struct RecordingOptions {
    std::filesystem::path directory;  ///< empty: nothing is recorded
    std::uint64_t limit = 0;          ///< bytes of all recordings in it, earlier ones included; 0: no limit
    /// Frames that wait for the disk, bytes over all sessions. Further ones are left out of their recordings.
    std::size_t waiting_limit = std::size_t{256} << 20;
    /// Of float32 attributes in the meshes, per component; 0: exact.
    int attribute_bits = default_attribute_bits;
    RecordingRetention retention{};
};

/// Throws InvalidInput if the directory is not one that can be written to, or made. Makes nothing.
void require_recordable(const RecordingOptions& options);

}  // namespace meniscus::server
