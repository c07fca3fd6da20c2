// Points to a file of their own.
#pragma once

#include <filesystem>
#include <span>

#include "meniscus/mesh.hpp"

namespace meniscus::formats {

/// Writes binary PLY with vertices alone, x y z float32 in world units, which read_particles() reads. Atomic. Throws
/// InvalidInput if the path cannot be written.
void write_points(const std::filesystem::path& path, std::span<const Point> points);

}  // namespace meniscus::formats
