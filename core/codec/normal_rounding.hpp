// The rounding of normals on their way through Draco.
#pragma once

#include <draco/attributes/point_attribute.h>

#include <cstdint>

#include "meniscus/mesh.hpp"

namespace meniscus {

/// The normal of a point as Draco has decoded it, at unit length.
Normal decoded_normal(const draco::PointAttribute& attribute, std::uint32_t point);

}  // namespace meniscus
