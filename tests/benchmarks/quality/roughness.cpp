#include "quality/roughness.hpp"

#include <vector>

#include "meniscus/error.hpp"
#include "neighbors.hpp"
#include "quality/grid.hpp"
#include "quality/triangle.hpp"

namespace meniscus::benchmarks::quality {
namespace {

using compare::Point;

constexpr double around = 5.0;  ///< radii: vertices whose mean normal counts
constexpr double wall = 10.0;   ///< radii: what is nearer to a wall is left out
constexpr double up = 0.7;      ///< least y of the unit normal of a vertex that faces up
constexpr std::size_t most_vertices = 20000;

/// The vertices whose triangles face up.
struct Facing {
    std::vector<Point> places;
    std::vector<Point> normals;  ///< mean of a vertex's triangles, twice their area long
    Point low{1e30, 1e30, 1e30};
    Point high{-1e30, -1e30, -1e30};

    explicit Facing(compare::SurfaceView surface) {
        std::vector<Point> sums(surface.positions.size());
        for (const Triangle& t : surface.triangles) {
            const Point normal = area_normal(surface.corners(t));
            for (const std::uint32_t corner : t) sums[corner] = compare::add_scaled(sums[corner], 1.0, normal);
        }
        for (std::size_t i = 0; i < sums.size(); ++i) {
            const Point& place = surface.positions[i];
            for (std::size_t a = 0; a < 3; ++a) {
                low[a] = std::min(low[a], place[a]);
                high[a] = std::max(high[a], place[a]);
            }
            if (!(sums[i][1] > up * length_of(sums[i]))) continue;
            places.push_back(place);
            normals.push_back(sums[i]);
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
    grid.fill(facing.places);
    std::vector<std::size_t> inner;
    for (std::size_t i = 0; i < facing.places.size(); ++i)
        if (facing.is_inner(facing.places[i])) inner.push_back(i);
    if (inner.empty()) throw InvalidInput("no part of the surface faces up away from its ends");

    std::vector<Angle> angles;
    double area = 0.0;
    double squares = 0.0;
    for (const std::size_t k : pick_evenly(inner.size(), most_vertices)) {
        const std::size_t i = inner[k];
        Point mean{};
        grid.for_each_near(facing.places[i], [&](std::size_t j) {
            const Point d = compare::subtract(facing.places[i], facing.places[j]);
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
