// Pictures of surfaces, all of one frame with the same camera.
#pragma once

#include <filesystem>

#include "quality/surfaces.hpp"

namespace meniscus::benchmarks::quality {

/// Writes FOLDER/<cloud>-<field>-<mode>.png, the whole frame, and the same with "-near", a part of it. y is up.
/// radius: world units.
void draw_surface(const Surface& surface, const Cloud& cloud, const Method& method, double radius,
                  const std::filesystem::path& folder);

}  // namespace meniscus::benchmarks::quality
