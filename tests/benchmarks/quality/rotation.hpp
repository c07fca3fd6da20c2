// Rotations.
#pragma once

#include <array>
#include <cmath>

#include "compare/vector_math.hpp"

namespace meniscus::benchmarks::quality {

using Rotation = std::array<compare::Point, 3>;  ///< rows

inline constexpr Rotation no_rotation{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};

/// About an axis of any length above 0, by an angle in radians (Rodrigues' formula).
inline Rotation rotation(const compare::Point& axis, double angle) {
    const double length = std::sqrt(compare::dot(axis, axis));
    const double x = axis[0] / length;
    const double y = axis[1] / length;
    const double z = axis[2] / length;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const double t = 1.0 - c;
    return {{{t * x * x + c, t * x * y - s * z, t * x * z + s * y},
             {t * x * y + s * z, t * y * y + c, t * y * z - s * x},
             {t * x * z - s * y, t * y * z + s * x, t * z * z + c}}};
}

inline compare::Point turn(const Rotation& rows, const compare::Point& p) {
    return {compare::dot(rows[0], p), compare::dot(rows[1], p), compare::dot(rows[2], p)};
}

}  // namespace meniscus::benchmarks::quality
