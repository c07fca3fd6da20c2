#include "compare/triangle_distance.hpp"

#include <algorithm>
#include <cmath>

#include "compare/vector_math.hpp"

namespace meniscus::compare {
namespace {

/// From the origin to the segment that starts at `start`.
double squared_distance_to_segment(const Point& start, const Point& direction) {
    const double length = dot(direction, direction);
    const double t = length > 0.0 ? std::clamp(-dot(start, direction) / length, 0.0, 1.0) : 0.0;
    const Point nearest = add_scaled(start, t, direction);
    return dot(nearest, nearest);
}

}  // namespace

double squared_distance(const Point& point, const std::array<Point, 3>& triangle) {
    const Point a = subtract(triangle[0], point);
    const Point b = subtract(triangle[1], point);
    const Point c = subtract(triangle[2], point);
    const Point ab = subtract(b, a);
    const Point bc = subtract(c, b);
    const Point ca = subtract(a, c);
    const Point normal = cross(ab, bc);
    const double square = dot(normal, normal);
    // The foot of the perpendicular, in barycentric coordinates times `square`.
    const double u = dot(normal, cross(b, c));
    const double v = dot(normal, cross(c, a));
    const double w = dot(normal, cross(a, b));
    if (square > 0.0 && u >= 0.0 && v >= 0.0 && w >= 0.0) {
        const double sum = u + v + w;
        const Point foot{(u * a[0] + v * b[0] + w * c[0]) / sum, (u * a[1] + v * b[1] + w * c[1]) / sum,
                         (u * a[2] + v * b[2] + w * c[2]) / sum};
        return dot(foot, foot);
    }
    return std::min(
        {squared_distance_to_segment(a, ab), squared_distance_to_segment(b, bc), squared_distance_to_segment(c, ca)});
}

double area(const std::array<Point, 3>& triangle) {
    const Point normal = cross(subtract(triangle[1], triangle[0]), subtract(triangle[2], triangle[0]));
    return 0.5 * std::sqrt(dot(normal, normal));
}

}  // namespace meniscus::compare
