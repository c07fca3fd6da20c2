// ParaView's .pvd: the files of a sequence, each with its time.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

#include "formats/bytes/atomic_file.hpp"

namespace meniscus::formats {

/// What lies around the files of a list.
inline constexpr std::string_view pvd_begin =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n  "
    "<Collection>\n";
inline constexpr std::string_view pvd_end = "  </Collection>\n</VTKFile>\n";

/// Writes it, atomically: what it was given, once commit() has been called. All throw as AtomicFile does.
class PvdWriter {
public:
    explicit PvdWriter(const std::filesystem::path& path);
    /// time: a number as text; or the frame's number. part: of those of the same time. file: relative to the list's
    /// folder.
    void add(std::string_view time, std::size_t part, std::string_view file);
    void commit();

private:
    AtomicFile file_;
};

struct PvdEntry {
    double time = 0.0;  ///< or the frame's number
    std::filesystem::path file;
};

/// Files are named relative to the list's folder.
void write_pvd(const std::filesystem::path& path, std::span<const PvdEntry> entries);

}  // namespace meniscus::formats
