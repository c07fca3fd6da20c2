#include "quality/sampling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "compare/vector_math.hpp"
#include "quality/random.hpp"
#include "quality/relaxation.hpp"
#include "quality/rotation.hpp"

namespace meniscus::benchmarks::quality {
namespace {

using compare::dot;
using compare::subtract;

/// A lattice's place: the origin, about which closed bodies are symmetric, is the middle of a cell.
constexpr Point middle{spacing / 2.0, spacing / 2.0, spacing / 2.0};
constexpr int phases = 64;  ///< places of a lattice, of which the best is taken
constexpr double jitter = 0.2 * spacing;
/// Before the relaxation: anywhere in the particle's cell of the lattice, so that nothing of the lattice remains.
constexpr double scatter = 0.5 * spacing;

/// A rotation that favors no direction of a lattice.
const Rotation generic = rotation({1.0, 2.0, 3.0}, 0.7);

/// The points of a turned lattice that lie in the shape.
std::vector<Point> cut_lattice(const Shape& shape, const Rotation& turned, const Point& phase) {
    const Point extent = subtract(shape.high, shape.low);
    const int reach = static_cast<int>(std::ceil(std::sqrt(dot(extent, extent)) / 2.0 / spacing)) + 1;
    const auto in_bounds = [&](const Point& p) {
        for (std::size_t a = 0; a < 3; ++a)
            if (p[a] <= shape.low[a] || p[a] >= shape.high[a]) return false;
        return true;
    };
    std::vector<Point> points;
    for (int k = -reach; k <= reach; ++k)
        for (int j = -reach; j <= reach; ++j)
            for (int i = -reach; i <= reach; ++i) {
                const Point p = turn(turned, {spacing * i + phase[0], spacing * j + phase[1], spacing * k + phase[2]});
                if (in_bounds(p) && shape.nearest(p).offset < 0.0) points.push_back(p);
            }
    return points;
}

/// A lattice along the axes whose place, of some, gives the number of points that fits the volume best.
std::vector<Point> cut_best_lattice(const Shape& shape, Random& random) {
    std::vector<Point> best;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < phases; ++i) {
        std::vector<Point> points = cut_lattice(shape, no_rotation, random.next_point(spacing / 2.0));
        const double error = std::abs(static_cast<double>(points.size()) * particle_volume - shape.volume);
        if (error >= least) continue;
        least = error;
        best = std::move(points);
    }
    return best;
}

/// A layer in columns over a square lattice in x and y. A column has the number of particles that its share of the
/// water asks for, evenly over its height; what is left over goes to the next column.
std::vector<Point> stack_columns(const Layer& layer) {
    const int reach = static_cast<int>(std::ceil(std::hypot(layer.patch.high[0], layer.patch.high[1]) / spacing)) + 1;
    std::vector<Point> points;
    double left_over = 0.0;
    for (int i = -reach; i < reach; ++i)
        for (int j = -reach; j < reach; ++j) {
            const Point foot{spacing * (i + 0.5), spacing * (j + 0.5), 0.0};
            if (!layer.patch.contains(foot)) continue;
            const double thickness = layer.thickness(foot[0]);
            const double wanted = thickness / spacing + left_over;
            const int count = std::max(static_cast<int>(std::lround(wanted)), 0);
            left_over = wanted - count;
            for (int k = 0; k < count; ++k) points.push_back({foot[0], foot[1], thickness * ((k + 0.5) / count - 0.5)});
        }
    return points;
}

void scatter_by(double size, std::vector<Point>& points, Random& random) {
    for (Point& p : points) p = compare::add_scaled(p, 1.0, random.next_point(size));
}

}  // namespace

std::vector<Point> sample(const Shape& shape, Sampling sampling) {
    Random random(shape.name);
    switch (sampling) {
        case Sampling::jittered: {
            std::vector<Point> points =
                shape.layer ? stack_columns(*shape.layer) : cut_lattice(shape, no_rotation, middle);
            scatter_by(jitter, points, random);
            return points;
        }
        case Sampling::rotated:
            return cut_lattice(shape, generic, middle);
        case Sampling::relaxed: {
            std::vector<Point> points = shape.layer ? stack_columns(*shape.layer) : cut_best_lattice(shape, random);
            scatter_by(scatter, points, random);
            relax(shape, points);
            return points;
        }
    }
    return {};
}

}  // namespace meniscus::benchmarks::quality
