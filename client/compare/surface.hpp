// A borrowed triangle mesh, the input of this library.
#pragma once

#include <array>
#include <span>
#include <string>

#include "meniscus/mesh.hpp"

namespace meniscus::compare {

using Point = std::array<double, 3>;

/// Borrowed. Positions are finite, in world units; triangles are indices into them.
struct SurfaceView {
    std::span<const Point> positions;
    std::span<const Triangle> triangles;

    std::array<Point, 3> corners(const Triangle& t) const {
        return {positions[t[0]], positions[t[1]], positions[t[2]]};
    }
};

/// Beyond this limit, squares of areas overflow.
inline constexpr double largest_coordinate = 1e60;

/// Throws InvalidInput, in one line that begins with `name`, unless the surface has area and coordinates of at most
/// `largest_coordinate` in size, as the other functions of this library require.
void validate(SurfaceView surface, const std::string& name);

}  // namespace meniscus::compare
