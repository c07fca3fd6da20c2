// Shapes whose surface is known: their samplings stand for them, and reconstructions are held against them.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "compare/surface.hpp"

namespace meniscus::benchmarks::quality {

using compare::Point;

/// How a point lies to a surface.
struct Nearest {
    double offset = 0.0;  ///< distance from the surface, radii; negative inside
    Point normal{};       ///< outward, unit length, at the nearest point of the surface
};

/// A rectangle in x and y, radii.
struct Rectangle {
    std::array<double, 2> low{};
    std::array<double, 2> high{};
    bool contains(const Point& p) const {
        return low[0] <= p[0] && p[0] <= high[0] && low[1] <= p[1] && p[1] <= high[1];
    }
    double area() const { return (high[0] - low[0]) * (high[1] - low[1]); }
};

/// Water between the heights -thickness / 2 and thickness / 2 (z), a patch of it.
struct Layer {
    std::function<double(double)> thickness;  ///< radii, at x; 0 or less: no water
    Rectangle patch;                          ///< all particles
    Rectangle inner;                          ///< the part that is judged: far enough from the rims to be free of them
    double inner_volume = 0.0;                ///< radii cubed
    bool level = true;                        ///< the same thickness everywhere
};

/// All lengths are particle radii.
struct Shape {
    std::string name;
    std::function<Nearest(const Point&)> nearest;
    double volume = 0.0;  ///< radii cubed; of a layer: of the patch
    Point low{};          ///< bounds
    Point high{};
    std::optional<Layer> layer;  ///< none: a closed body

    bool is_judged_at(const Point& p) const { return !layer || layer->inner.contains(p); }
};

/// slab 16 r, sheet 4 r, film 2 r, balls of radius 10 and 30 r, torus (12, 5) r, two drops of radius 4 r with 2 r
/// between them, and a wedge that thins out from 8 r to nothing over 64 r.
std::vector<Shape> make_shapes();

/// radius: radii.
Shape make_ball(std::string name, double radius);

/// Water at rest, 40 r wide, 20 r high and 40 r long. Only its middle is judged.
Shape make_pool();

}  // namespace meniscus::benchmarks::quality
