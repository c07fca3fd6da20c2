// ParaView's .pvd: the files of a sequence, each with its time.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace meniscus::formats {

struct PvdEntry {
    double time = 0.0;  ///< or the frame's number
    std::filesystem::path file;
    std::size_t part = 0;  ///< of those of the same time
};

/// Writes it, atomically. Files are named relative to its folder. Throws InvalidInput if the path cannot be written,
/// and std::runtime_error if writing fails.
void write_pvd(const std::filesystem::path& path, std::span<const PvdEntry> entries);

}  // namespace meniscus::formats
