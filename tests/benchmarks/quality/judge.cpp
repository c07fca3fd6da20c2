#include "quality/judge.hpp"

#include <algorithm>
#include <cmath>

#include "compare/vector_math.hpp"
#include "meniscus/error.hpp"
#include "quality/sampling.hpp"
#include "quality/triangle.hpp"

namespace meniscus::benchmarks::quality {
namespace {

using compare::add_scaled;
using compare::cross;
using compare::dot;
using compare::subtract;

/// The part of a polygon on one side of a plane across an axis: above `limit` if sign is 1, below if it is -1.
std::vector<Point> clip(const std::vector<Point>& polygon, std::size_t axis, double limit, double sign) {
    std::vector<Point> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point& from = polygon[i];
        const Point& to = polygon[(i + 1) % polygon.size()];
        const double a = sign * (from[axis] - limit);
        const double b = sign * (to[axis] - limit);
        if (a >= 0.0) kept.push_back(from);
        if ((a >= 0.0) != (b >= 0.0)) kept.push_back(add_scaled(from, a / (a - b), subtract(to, from)));
    }
    return kept;
}

/// Calls visit(part) for triangles that make up what of a triangle is over the rectangle.
void for_each_part(const Corners& corners, const Rectangle& over, const auto& visit) {
    std::vector<Point> polygon(corners.begin(), corners.end());
    for (std::size_t axis = 0; axis < 2; ++axis) {
        polygon = clip(polygon, axis, over.low[axis], 1.0);
        polygon = clip(polygon, axis, over.high[axis], -1.0);
    }
    for (std::size_t i = 2; i < polygon.size(); ++i) visit(Corners{polygon[0], polygon[i - 1], polygon[i]});
}

double layer_volume(const Layer& layer, compare::SurfaceView surface) {
    double volume = 0.0;
    for (const Triangle& t : surface.triangles)
        for_each_part(surface.corners(t), layer.inner,
                      [&](const Corners& part) { volume += area_normal(part)[2] / 2.0 * center_of(part)[2]; });
    return volume;
}

/// Sums of squared angles, weighted by area.
struct Angles {
    double area = 0.0;
    double squares = 0.0;

    void add(double weight, const Point& normal, const Point& truth) {
        if (!(length_of(normal) > 0.0)) return;
        const double angle = angle_between(normal, truth);
        area += weight;
        squares += weight * angle * angle;
    }
    double rms_degrees() const { return degrees(std::sqrt(squares / area)); }
};

/// Twice the area of a vertex's triangles, in the direction of their mean normal, for every vertex.
std::vector<Point> vertex_normals(compare::SurfaceView surface) {
    std::vector<Point> normals(surface.positions.size());
    for (const Triangle& t : surface.triangles) {
        const Point normal = area_normal(surface.corners(t));
        for (const std::uint32_t corner : t) normals[corner] = add_scaled(normals[corner], 1.0, normal);
    }
    return normals;
}

void judge_vertices(const Shape& shape, compare::SurfaceView surface, std::span<const Normal> given, Deviation& out) {
    const std::vector<Point> means = vertex_normals(surface);
    Angles angles;
    for (std::size_t i = 0; i < means.size(); ++i) {
        const Point& place = surface.positions[i];
        if (!shape.is_judged_at(place)) continue;
        const Nearest nearest = shape.nearest(place);
        out.worst = std::max(out.worst, std::abs(nearest.offset));
        const Point normal = given.empty() ? means[i] : Point{given[i][0], given[i][1], given[i][2]};
        angles.add(length_of(means[i]), normal, nearest.normal);
    }
    out.degrees = angles.rms_degrees();
}

}  // namespace

double thickness_at_end(const Layer& layer, compare::SurfaceView surface) {
    double covered = 0.0;
    for (const Triangle& t : surface.triangles)
        for_each_part(surface.corners(t), layer.inner, [&](const Corners& part) {
            covered += std::abs(area_normal(part)[2]) / 4.0;  // there are an upper and a lower side
        });
    return layer.thickness(layer.inner.low[0] + covered / (layer.inner.high[1] - layer.inner.low[1]));
}

double enclosed_volume(compare::SurfaceView surface) {
    double six_times = 0.0;
    for (const Triangle& t : surface.triangles) {
        const Corners c = surface.corners(t);
        six_times += dot(c[0], cross(c[1], c[2]));
    }
    return six_times / 6.0;
}

Deviation judge(const Shape& shape, compare::SurfaceView surface, std::span<const Normal> normals,
                std::size_t particles) {
    Deviation out;
    Angles angles;
    double area = 0.0;
    double offsets = 0.0;
    double squared_offsets = 0.0;
    for (const Triangle& t : surface.triangles) {
        const Corners corners = surface.corners(t);
        const Point center = center_of(corners);
        if (!shape.is_judged_at(center)) continue;
        const Point normal = area_normal(corners);
        const double weight = length_of(normal);
        const Nearest nearest = shape.nearest(center);
        area += weight;
        offsets += weight * nearest.offset;
        squared_offsets += weight * nearest.offset * nearest.offset;
        angles.add(weight, normal, nearest.normal);
    }
    if (!(area > 0.0)) throw InvalidInput("the surface of " + shape.name + " is empty");
    out.offset = offsets / area;
    out.rms = std::sqrt(std::max(squared_offsets / area - out.offset * out.offset, 0.0));
    out.triangle_degrees = angles.rms_degrees();
    judge_vertices(shape, surface, normals, out);
    const double whole = enclosed_volume(surface);
    out.particle_volume = whole / (static_cast<double>(particles) * particle_volume);
    out.volume = shape.layer ? layer_volume(*shape.layer, surface) / shape.layer->inner_volume : whole / shape.volume;
    return out;
}

}  // namespace meniscus::benchmarks::quality
