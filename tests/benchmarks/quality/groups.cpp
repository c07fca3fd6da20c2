#include "quality/groups.hpp"

#include <cmath>
#include <numbers>

#include "compare/vector_math.hpp"
#include "quality/judge.hpp"
#include "quality/random.hpp"
#include "quality/rotation.hpp"
#include "quality/sampling.hpp"

namespace meniscus::benchmarks::quality {
namespace {

using compare::cross;
using compare::dot;
using compare::subtract;

std::vector<Point> cube(int edge_particles, double apart) {
    std::vector<Point> places;
    for (int k = 0; k < edge_particles; ++k)
        for (int j = 0; j < edge_particles; ++j)
            for (int i = 0; i < edge_particles; ++i) places.push_back({apart * i, apart * j, apart * k});
    return places;
}

std::vector<Point> row(int particles, double apart) {
    std::vector<Point> places;
    places.reserve(static_cast<std::size_t>(particles));
    for (int i = 0; i < particles; ++i) places.push_back({apart * i, 0.0, 0.0});
    return places;
}

/// How often the surface winds around a point: 1 inside, 0 outside (Van Oosterom and Strackee's solid angles).
double winding(const Point& p, compare::SurfaceView surface) {
    double half_angle = 0.0;
    for (const Triangle& t : surface.triangles) {
        std::array<Point, 3> d;
        std::array<double, 3> length{};
        for (std::size_t i = 0; i < 3; ++i) {
            d[i] = subtract(surface.positions[t[i]], p);
            length[i] = std::sqrt(dot(d[i], d[i]));
        }
        half_angle +=
            std::atan2(dot(d[0], cross(d[1], d[2])), length[0] * length[1] * length[2] + dot(d[0], d[1]) * length[2] +
                                                         dot(d[1], d[2]) * length[0] + dot(d[2], d[0]) * length[1]);
    }
    return half_angle / (2.0 * std::numbers::pi);
}

}  // namespace

std::vector<Group> make_groups() {
    const double edge = 1.5;
    const double leg = std::numbers::sqrt2;  // of a cube whose face diagonals are 2 r
    return {{"one", {{0.0, 0.0, 0.0}}},
            {"two at 2 r", row(2, 2.0)},
            {"three in one place", row(3, 0.0)},
            {"three at 1.5 r", {{0.0, 0.0, 0.0}, {edge, 0.0, 0.0}, {edge / 2.0, edge * std::sqrt(0.75), 0.0}}},
            {"tetrahedron of 2 r", {{0.0, 0.0, 0.0}, {leg, leg, 0.0}, {leg, 0.0, leg}, {0.0, leg, leg}}},
            {"cube of 8 at 2 r", cube(2, 2.0)},
            {"cube of 8 at 1.6 r", cube(2, 1.6)},
            {"cube of 27 at 2 r", cube(3, 2.0)},
            {"row at 2 r", row(10, 2.0)},
            {"row at 1 r", row(10, 1.0)}};
}

std::vector<Point> place(const Group& group, int placement) {
    Random random(std::to_string(placement));
    const Point move = random.next_point(spacing);
    const Point axis = random.next_point(1.0);
    const Rotation turned = rotation(axis, std::numbers::pi * random.next());
    std::vector<Point> places;
    for (const Point& p : group.places) places.push_back(compare::add_scaled(move, 1.0, turn(turned, p)));
    return places;
}

GroupFigures judge_group(const std::vector<Point>& places, compare::SurfaceView surface) {
    GroupFigures out;
    out.volume = enclosed_volume(surface) / (static_cast<double>(places.size()) * particle_volume);
    for (const Point& p : places)
        if (winding(p, surface) < 0.5) ++out.lost;
    return out;
}

}  // namespace meniscus::benchmarks::quality
