// ParaView's .pvd: the files of a sequence, each with its time.
#pragma once

#include <filesystem>
#include <span>

namespace meniscus::formats {

struct PvdEntry {
    double time = 0.0;  ///< or the frame's number
    std::filesystem::path file;
};

/// Writes it, atomically. Files are named relative to its folder. Throws InvalidInput if the path cannot be written.
void write_pvd(const std::filesystem::path& path, std::span<const PvdEntry> entries);

}  // namespace meniscus::formats
