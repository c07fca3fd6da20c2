// Colors of a surface point.
#pragma once

#include <array>
#include <cstdint>

#include "picture/color_maps.hpp"
#include "picture/rasterizer.hpp"

namespace meniscus::cli {

/// Water under a bright sky and two lights. normal: unit, view space (z towards the viewer), turned towards the viewer;
/// up: the world's up in view space.
Color water(const std::array<float, 3>& normal, const std::array<float, 3>& up);

/// A surface of a color, lit so that its shape is seen and its color stays that of the legend. rgb: sRGB, 0 to 255;
/// normal: as in water().
Color colored(const std::array<float, 3>& rgb, const std::array<float, 3>& normal);

/// A triangle of a wireframe: its lines in the color of its level (1 blue, 2 green, 3 red, crack 0 purple), its face
/// almost white. line: 0 on the face to 1 on a line. facing: cosine between normal and viewer.
Color wire(std::uint8_t level, float line, float facing);

}  // namespace meniscus::cli
