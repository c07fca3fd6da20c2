#include "quality/roughness.hpp"

#include <vector>

#include "meniscus/error.hpp"
#include "neighbors.hpp"
#include "quality/grid.hpp"
#include "quality/triangle.hpp"

namespace meniscus::benchmarks::quality {
namespace {

using compare::Point;

constexpr double around = 5.0;  ///< radii: triangles whose mean normal counts
constexpr double wall = 10.0;   ///< radii: what is nearer to a wall is left out
constexpr double up = 0.5;      ///< least y of the unit normal of a triangle that faces up
constexpr std::size_t most_triangles = 20000;

/// The triangles that face up.
struct Facing {
    std::vector<Point> centers;
    std::vector<Point> normals;  ///< twice the area long
    Point low{1e30, 1e30, 1e30};
    Point high{-1e30, -1e30, -1e30};

    explicit Facing(compare::SurfaceView surface) {
        for (const Triangle& t : surface.triangles) {
            const Corners corners = surface.corners(t);
            const Point normal = area_normal(corners);
            const Point center = center_of(corners);
            for (std::size_t a = 0; a < 3; ++a) {
                low[a] = std::min(low[a], center[a]);
                high[a] = std::max(high[a], center[a]);
            }
            if (!(normal[1] > up * length_of(normal))) continue;
            centers.push_back(center);
            normals.push_back(normal);
        }
    }

    bool is_inner(const Point& p) const {
        return p[0] > low[0] + wall && p[0] < high[0] - wall && p[2] > low[2] + wall && p[2] < high[2] - wall;
    }
};

struct Angle {
    double radians = 0.0;
    double area = 0.0;
};

double median_of(std::vector<Angle> angles, double area) {
    std::sort(angles.begin(), angles.end(), [](const Angle& a, const Angle& b) { return a.radians < b.radians; });
    double below = 0.0;
    for (const Angle& angle : angles) {
        below += angle.area;
        if (2.0 * below >= area) return angle.radians;
    }
    return 0.0;
}

}  // namespace

Roughness roughness_of(compare::SurfaceView surface) {
    const Facing facing(surface);
    Grid grid(facing.low, facing.high, around);
    grid.fill(facing.centers);
    std::vector<std::size_t> inner;
    for (std::size_t i = 0; i < facing.centers.size(); ++i)
        if (facing.is_inner(facing.centers[i])) inner.push_back(i);
    if (inner.empty()) throw InvalidInput("no part of the surface faces up away from its ends");

    std::vector<Angle> angles;
    double area = 0.0;
    double squares = 0.0;
    for (const std::size_t k : pick_evenly(inner.size(), most_triangles)) {
        const std::size_t i = inner[k];
        Point mean{};
        grid.for_each_near(facing.centers[i], [&](std::size_t j) {
            const Point d = compare::subtract(facing.centers[i], facing.centers[j]);
            if (compare::dot(d, d) < around * around) mean = compare::add_scaled(mean, 1.0, facing.normals[j]);
        });
        const Angle angle{angle_between(facing.normals[i], mean), length_of(facing.normals[i])};
        angles.push_back(angle);
        area += angle.area;
        squares += angle.area * angle.radians * angle.radians;
    }
    return {degrees(std::sqrt(squares / area)), degrees(median_of(std::move(angles), area))};
}

}  // namespace meniscus::benchmarks::quality
