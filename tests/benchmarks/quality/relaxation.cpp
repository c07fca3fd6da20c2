#include "quality/relaxation.hpp"

#include <algorithm>
#include <cmath>

#include "compare/vector_math.hpp"
#include "quality/grid.hpp"
#include "quality/sampling.hpp"

namespace meniscus::benchmarks::quality {
namespace {

using compare::add_scaled;
using compare::dot;
using compare::subtract;

constexpr int steps = 300;
/// Radii by which a push of 1 moves a particle; with up to some 13 neighbors, 0.7 would swing.
constexpr double mobility = 0.4;
constexpr double range = 1.5 * spacing;
constexpr double depth = 1.0;
/// The widest spacing in a layer that thins out, over `spacing`.
constexpr double widest = 3.0;

/// The factor of the spacing: a layer thinner than a spacing holds the same volume per particle farther apart.
double widening(const Shape& shape, const Point& p) {
    if (!shape.layer) return 1.0;
    const double thickness = shape.layer->thickness(p[0]);
    if (thickness >= spacing) return 1.0;
    return thickness > 0.0 ? std::min(std::sqrt(spacing / thickness), widest) : widest;
}

/// The patch's period along an axis; 0: none.
std::array<double, 3> periods(const Shape& shape) {
    if (!shape.layer) return {};
    return {shape.layer->level ? shape.high[0] - shape.low[0] : 0.0, shape.high[1] - shape.low[1], 0.0};
}

void keep_inside(const Shape& shape, const std::array<double, 3>& period, Point& p) {
    if (!shape.layer) {
        const Nearest nearest = shape.nearest(p);
        if (nearest.offset > -depth) p = add_scaled(p, -depth - nearest.offset, nearest.normal);
        return;
    }
    for (std::size_t a = 0; a < 2; ++a) {
        if (period[a] > 0.0)
            p[a] -= period[a] * std::floor((p[a] - shape.low[a]) / period[a]);
        else
            p[a] = std::clamp(p[a], shape.low[a] + depth, shape.high[a] - depth);
    }
    const double highest = std::max(shape.layer->thickness(p[0]) / 2.0 - depth, 0.0);
    p[2] = std::clamp(p[2], -highest, highest);
}

}  // namespace

void relax(const Shape& shape, std::vector<Point>& points) {
    const std::array<double, 3> period = periods(shape);
    const bool thins_out = shape.layer && !shape.layer->level;
    Grid grid(shape.low, shape.high, range * (thins_out ? widest : 1.0), period);
    std::vector<double> widenings(points.size());
    std::vector<Point> moved(points.size());
    for (Point& p : points) keep_inside(shape, period, p);
    for (int step = 0; step < steps; ++step) {
        grid.fill(points);
        for (std::size_t i = 0; i < points.size(); ++i) widenings[i] = widening(shape, points[i]);
        for (std::size_t i = 0; i < points.size(); ++i) {
            Point push{};
            grid.for_each_near(points[i], [&](std::size_t j) {
                Point away = subtract(points[i], points[j]);
                for (std::size_t a = 0; a < 3; ++a)
                    if (period[a] > 0.0) away[a] -= period[a] * std::round(away[a] / period[a]);
                const double distance = std::sqrt(dot(away, away));
                const double reach = range * (widenings[i] + widenings[j]) / 2.0;
                if (distance > 0.0 && distance < reach)
                    push = add_scaled(push, (1.0 - distance / reach) / distance, away);
            });
            moved[i] = add_scaled(points[i], mobility * widenings[i], push);
            keep_inside(shape, period, moved[i]);
        }
        points.swap(moved);
    }
}

}  // namespace meniscus::benchmarks::quality
