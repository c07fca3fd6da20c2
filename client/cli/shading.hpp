// Colors of a surface point.
#pragma once

#include <array>
#include <cstdint>

#include "cli/rasterizer.hpp"

namespace meniscus::cli {

/// Water under a bright sky and two lights. normal: unit, view space (z towards the viewer), turned towards the viewer;
/// up: the world's up in view space.
Color water(const std::array<float, 3>& normal, const std::array<float, 3>& up);

/// A triangle of a wireframe: its lines in the color of its level (1 blue, 2 green, 3 red, crack 0 purple), its face
/// almost white. line: 0 on the face to 1 on a line. facing: cosine between normal and viewer.
Color wire(std::uint8_t level, float line, float facing);

}  // namespace meniscus::cli
