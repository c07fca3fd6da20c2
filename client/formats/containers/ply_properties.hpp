// Arrays of points as properties of PLY's vertices.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "meniscus/particle_frame.hpp"

namespace meniscus::formats {

/// The lines of the header. An array of one component is a property of its name, with several components NAME_x,
/// NAME_y, NAME_z, NAME_w; uint8 of 3 or 4 under the name color are red, green, blue, alpha.
std::string ply_properties(std::span<const ParticleArray> arrays);

/// Appends an array's values of one point, little-endian.
inline void append_element(std::string& out, const ParticleArray& array, std::size_t point) {
    const std::size_t bytes = array.element_bytes();
    out.append(reinterpret_cast<const char*>(array.data.data()) + point * bytes, bytes);
}

}  // namespace meniscus::formats
