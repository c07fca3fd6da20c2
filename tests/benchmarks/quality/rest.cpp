#include "quality/rest.hpp"

#include <algorithm>
#include <cmath>

#include "compare/samples.hpp"
#include "compare/triangle_tree.hpp"
#include "compare/vector_math.hpp"
#include "meniscus/error.hpp"
#include "quality/grid.hpp"

namespace meniscus::benchmarks::quality {
namespace {

using compare::add_scaled;
using compare::dot;
using compare::subtract;

constexpr double near_by = 6.0;     ///< radii: particles that make the surface
constexpr double still = 0.3;       ///< radii from one frame to the next, against the mean of those around
constexpr std::size_t fewest = 20;  ///< particles around: lone drops say nothing
constexpr std::size_t places = 50000;

/// The box around the points.
std::array<Point, 2> corners_of(const std::vector<Point>& points) {
    std::array<Point, 2> box{points.at(0), points.at(0)};
    for (const Point& p : points)
        for (std::size_t a = 0; a < 3; ++a) {
            box[0][a] = std::min(box[0][a], p[a]);
            box[1][a] = std::max(box[1][a], p[a]);
        }
    return box;
}

}  // namespace

Rest find_rest(compare::SurfaceView surface, const std::vector<Point>& particles, const std::vector<Point>& next) {
    if (particles.size() != next.size())
        throw InvalidInput("the next frame has " + std::to_string(next.size()) + " particles, but should have " +
                           std::to_string(particles.size()));
    const auto [low, high] = corners_of(particles);
    Grid grid(low, high, near_by);
    grid.fill(particles);
    Rest rest;
    const compare::Samples looked_at = compare::sample(surface, compare::find_components(surface), places);
    for (const Point& p : looked_at.points) {
        std::vector<Point> moves;
        Point mean{};
        grid.for_each_near(p, [&](std::size_t i) {
            const Point d = subtract(particles[i], p);
            if (dot(d, d) >= near_by * near_by) return;
            moves.push_back(subtract(next[i], particles[i]));
            mean = add_scaled(mean, 1.0, moves.back());
        });
        if (moves.size() < fewest) continue;
        for (double& coordinate : mean) coordinate /= static_cast<double>(moves.size());
        const bool together = std::all_of(moves.begin(), moves.end(), [&](const Point& move) {
            const Point d = subtract(move, mean);
            return dot(d, d) < still * still;
        });
        if (together) rest.places.push_back(add_scaled(p, 1.0, mean));
    }
    rest.share = static_cast<double>(rest.places.size()) / static_cast<double>(looked_at.points.size());
    return rest;
}

double motion_at(const std::vector<Point>& places, compare::SurfaceView surface) {
    if (places.empty()) return 0.0;
    const compare::TriangleTree tree(surface);
    std::uint32_t hint = 0;
    double squares = 0.0;
    for (const Point& p : places) squares += tree.squared_distance(p, hint);
    return std::sqrt(squares / static_cast<double>(places.size()));
}

}  // namespace meniscus::benchmarks::quality
