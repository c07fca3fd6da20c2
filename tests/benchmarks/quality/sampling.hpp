// Particles that stand for a shape.
#pragma once

#include <string_view>
#include <vector>

#include "meniscus/names.hpp"
#include "quality/shapes.hpp"

namespace meniscus::benchmarks::quality {

enum class Sampling : std::uint8_t {
    jittered,  ///< a cubic lattice along the axes, each particle off its place by up to a fifth of the spacing on each
    rotated,   ///< a cubic lattice turned by a fixed rotation that favors no direction
    relaxed,   ///< particles that pushed each other apart until they lay evenly, as those of SPH do
};
constexpr std::string_view name_of(Sampling sampling) {
    switch (sampling) {
        case Sampling::jittered:
            return "jittered";
        case Sampling::rotated:
            return "rotated";
        case Sampling::relaxed:
            return "relaxed";
    }
    return {};
}

/// Spacing of the particles, radii: each stands for a volume of 8.
inline constexpr double spacing = 2.0;
inline constexpr double particle_volume = spacing * spacing * spacing;

/// Places in radii, the same on every run. The lattices lie with a cell's middle at the shape's, so that a cut through
/// them holds up to 5 % more or less than the shape's volume; the relaxed particles are as many as fit it best.
std::vector<Point> sample(const Shape& shape, Sampling sampling);

}  // namespace meniscus::benchmarks::quality
