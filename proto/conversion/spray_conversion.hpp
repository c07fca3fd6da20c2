// Spray beside a mesh: points, and the messages that carry them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "meniscus/mesh.hpp"
#include "meniscus/v1/mesh.pb.h"

namespace meniscus::conversion {

/// x y z, float32.
inline constexpr std::size_t spray_point_bytes = 12;
/// Whole points within the 1 MiB of a chunk.
inline constexpr std::size_t max_points_per_message = (std::size_t{1} << 20) / spray_point_bytes;

/// None without points.
std::vector<v1::SprayPoints> to_wire(std::span<const Point> points);

/// Appends the message's points. Throws InvalidInput unless they are 1 to max_points_per_message whole ones, all
/// finite.
void append_points(const v1::SprayPoints& message, std::vector<Point>& points);

}  // namespace meniscus::conversion
