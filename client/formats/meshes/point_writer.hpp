// Points to a file of their own.
#pragma once

#include <array>
#include <filesystem>
#include <span>

#include "meniscus/mesh.hpp"

namespace meniscus::formats {

/// Writes binary PLY with vertices alone, x y z in world units, which read_particles() reads. Atomic. origin: added to
/// the points; they are float64 with one, else float32. Throws InvalidInput if the path cannot be written.
void write_points(const std::filesystem::path& path, std::span<const Point> points,
                  const std::array<double, 3>& origin = {});

}  // namespace meniscus::formats
