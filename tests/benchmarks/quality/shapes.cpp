#include "quality/shapes.hpp"

#include <cmath>
#include <numbers>

#include "compare/vector_math.hpp"

namespace meniscus::benchmarks::quality {
namespace {

using compare::dot;
using compare::subtract;

/// Half the edge of a patch of a layer, and of the part in its middle that is judged. The influence of the rims ends
/// two of the widest supports (7 r) from them.
constexpr double half_patch = 32.0;
constexpr double rim = 14.0;
constexpr double half_inner = half_patch - rim;

Nearest nearest_on_sphere(const Point& p, const Point& center, double radius) {
    const Point d = subtract(p, center);
    const double distance = std::sqrt(dot(d, d));
    if (!(distance > 0.0)) return {-radius, {0.0, 0.0, 1.0}};
    return {distance - radius, {d[0] / distance, d[1] / distance, d[2] / distance}};
}

double sphere_volume(double radius) {
    return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
}

Rectangle square(double half_edge) {
    return {{-half_edge, -half_edge}, {half_edge, half_edge}};
}

Shape make_layer(std::string name, double thickness, double half_edge, double half_inner_edge) {
    Shape shape;
    shape.name = std::move(name);
    shape.nearest = [thickness](const Point& p) {
        return Nearest{std::abs(p[2]) - thickness / 2.0, {0.0, 0.0, p[2] < 0.0 ? -1.0 : 1.0}};
    };
    Layer layer;
    layer.thickness = [thickness](double) { return thickness; };
    layer.patch = square(half_edge);
    layer.inner = square(half_inner_edge);
    layer.inner_volume = thickness * layer.inner.area();
    shape.volume = thickness * layer.patch.area();
    shape.low = {-half_edge, -half_edge, -thickness / 2.0};
    shape.high = {half_edge, half_edge, thickness / 2.0};
    shape.layer = std::move(layer);
    return shape;
}

Shape make_layer(std::string name, double thickness) {
    return make_layer(std::move(name), thickness, half_patch, half_inner);
}

/// Its thin end is in the judged part.
Shape make_wedge(double thick_end) {
    const double slope = thick_end / (2.0 * half_patch);
    const auto thickness = [slope](double x) { return slope * (half_patch - x); };
    const double cosine = 1.0 / std::hypot(1.0, slope / 2.0);
    Shape shape;
    shape.name = "wedge";
    shape.nearest = [thickness, slope, cosine](const Point& p) {
        return Nearest{cosine * (std::abs(p[2]) - thickness(p[0]) / 2.0),
                       {cosine * slope / 2.0, 0.0, p[2] < 0.0 ? -cosine : cosine}};
    };
    Layer layer;
    layer.thickness = thickness;
    layer.patch = square(half_patch);
    layer.inner = {{-half_inner, -half_inner}, {half_patch + rim, half_inner}};
    const double length = half_patch + half_inner;
    layer.inner_volume = slope * length * length / 2.0 * (2.0 * half_inner);
    layer.level = false;
    shape.volume = thick_end / 2.0 * layer.patch.area();
    shape.low = {-half_patch, -half_patch, -thick_end / 2.0};
    shape.high = {half_patch, half_patch, thick_end / 2.0};
    shape.layer = std::move(layer);
    return shape;
}

/// ring: radius of the circle in its middle; tube: radius of its cross-section.
Shape make_torus(double ring, double tube) {
    Shape shape;
    shape.name = "torus";
    shape.nearest = [ring, tube](const Point& p) {
        const double from_axis = std::hypot(p[0], p[1]);
        if (!(from_axis > 0.0)) return nearest_on_sphere(p, {ring, 0.0, 0.0}, tube);
        return nearest_on_sphere(p, {ring * p[0] / from_axis, ring * p[1] / from_axis, 0.0}, tube);
    };
    shape.volume = 2.0 * std::numbers::pi * std::numbers::pi * ring * tube * tube;
    shape.low = {-ring - tube, -ring - tube, -tube};
    shape.high = {ring + tube, ring + tube, tube};
    return shape;
}

Shape make_drops(double radius, double gap) {
    const double half = radius + gap / 2.0;
    Shape shape;
    shape.name = "drops";
    shape.nearest = [radius, half](const Point& p) {
        return nearest_on_sphere(p, {p[0] < 0.0 ? -half : half, 0.0, 0.0}, radius);
    };
    shape.volume = 2.0 * sphere_volume(radius);
    shape.low = {-half - radius, -radius, -radius};
    shape.high = {half + radius, radius, radius};
    return shape;
}

}  // namespace

Shape make_ball(std::string name, double radius) {
    Shape shape;
    shape.name = std::move(name);
    shape.nearest = [radius](const Point& p) { return nearest_on_sphere(p, {}, radius); };
    shape.volume = sphere_volume(radius);
    shape.low = {-radius, -radius, -radius};
    shape.high = {radius, radius, radius};
    return shape;
}

Shape make_pool() {
    return make_layer("pool", 20.0, 20.0, 10.0);
}

std::vector<Shape> make_shapes() {
    return {make_layer("slab", 16.0),  make_layer("sheet", 4.0), make_layer("film", 2.0), make_ball("ball10", 10.0),
            make_ball("ball30", 30.0), make_torus(12.0, 5.0),    make_drops(4.0, 2.0),    make_wedge(8.0)};
}

}  // namespace meniscus::benchmarks::quality
