// Arrays of points in legacy VTK.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "meniscus/particle_frame.hpp"

namespace meniscus::formats {

/// "FIELD FieldData N" with them; nothing without any. In binary, thus big-endian.
std::string vtk_field(std::span<const ParticleArray> arrays, std::size_t points);

}  // namespace meniscus::formats
