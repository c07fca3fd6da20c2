// The rounding of normals on their way through Draco.
#pragma once

#include <draco/attributes/point_attribute.h>

#include <cstdint>

#include "meniscus/mesh.hpp"

namespace meniscus {

/// Throws InvalidInput unless they are 2 to 16, or 0 for no normals.
void check_normal_bits(int normal_bits);

/// The normal of a point as Draco has decoded it, at unit length.
Normal decoded_normal(const draco::PointAttribute& attribute, std::uint32_t point);

}  // namespace meniscus
