// Surfaces to files.
#pragma once

#include <filesystem>

#include "cli/surfaces.hpp"

namespace meniscus::cli {

/// Throws InvalidInput unless the path's folder exists: to be called before long work.
void check_folder(const std::filesystem::path& path);
/// Throws InvalidInput unless the extension is .ply, .obj or .bricks and the folder exists: to be called before long
/// work.
void check_mesh_path(const std::filesystem::path& path);
/// Writes the format that the extension names.
void write_surface(const std::filesystem::path& path, const Surface& surface);

/// "DIR/frame_000012.ply"
std::filesystem::path frame_path(const std::filesystem::path& directory, std::uint64_t index,
                                 const std::string& extension);

}  // namespace meniscus::cli
