// Figures of one triangle.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "compare/vector_math.hpp"

namespace meniscus::benchmarks::quality {

using Corners = std::array<compare::Point, 3>;

inline compare::Point center_of(const Corners& c) {
    return {(c[0][0] + c[1][0] + c[2][0]) / 3.0, (c[0][1] + c[1][1] + c[2][1]) / 3.0,
            (c[0][2] + c[1][2] + c[2][2]) / 3.0};
}

/// The normal, twice the area long.
inline compare::Point area_normal(const Corners& c) {
    return compare::cross(compare::subtract(c[1], c[0]), compare::subtract(c[2], c[0]));
}

inline double length_of(const compare::Point& v) {
    return std::sqrt(compare::dot(v, v));
}

/// Radians; of vectors longer than 0.
inline double angle_between(const compare::Point& a, const compare::Point& b) {
    return std::acos(std::clamp(compare::dot(a, b) / (length_of(a) * length_of(b)), -1.0, 1.0));
}

inline double degrees(double radians) {
    return radians * 180.0 / std::numbers::pi;
}

}  // namespace meniscus::benchmarks::quality
