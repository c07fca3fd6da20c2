// Distance between a point and a triangle.
#pragma once

#include <array>

#include "compare/surface.hpp"

namespace meniscus::compare {

/// Square of the distance from `point` to the nearest point of the triangle, interior and border. A triangle without
/// area is the segment or point that it covers.
double squared_distance(const Point& point, const std::array<Point, 3>& triangle);

/// World units squared.
double area(const std::array<Point, 3>& triangle);

}  // namespace meniscus::compare
