// Positions and corners of meshes as the bytes of files.
#pragma once

#include <array>
#include <bit>
#include <span>
#include <string>
#include <vector>

#include "formats/bytes/scalar.hpp"

namespace meniscus::formats {

/// Coordinates as float64 where `wide`, else rounded to float32.
inline std::string coordinate_bytes(const std::vector<std::array<double, 3>>& positions, bool wide,
                                    std::endian order = std::endian::little) {
    std::string out;
    out.reserve(positions.size() * 3 * (wide ? sizeof(double) : sizeof(float)));
    for (const auto& position : positions)
        for (const double x : position) wide ? store(out, x, order) : store(out, static_cast<float>(x), order);
    return out;
}

}  // namespace meniscus::formats
