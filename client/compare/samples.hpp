// Points spread over a surface.
#pragma once

#include <cstddef>
#include <vector>

#include "compare/components.hpp"
#include "compare/surface.hpp"

namespace meniscus::compare {

/// The least number of samples of a component, however small it is.
inline constexpr std::size_t fewest_samples_per_component = 16;

struct Samples {
    std::vector<Point> points;        ///< by component
    std::vector<double> weights;      ///< per point: the area that it stands for, world units squared
    std::vector<std::size_t> starts;  ///< component k has the points starts[k] ... starts[k + 1] - 1

    double area() const;  ///< of the whole surface, world units squared
};

/// About `count` points, the same on every run: one in each of equal shares of a component's area. Small components
/// may add to their number.
Samples sample(SurfaceView surface, const Components& components, std::size_t count);

}  // namespace meniscus::compare
