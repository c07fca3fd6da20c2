// Particles push each other apart within a shape until they lie evenly.
#pragma once

#include <vector>

#include "quality/shapes.hpp"

namespace meniscus::benchmarks::quality {

/// Each particle is pushed away by those within one and a half spacings, the more the nearer, and keeps one radius away
/// from the shape's surface, as the outermost particles of a fluid do; where a layer is thinner than that, it keeps to
/// its middle, and the spacing grows as the layer thins. A layer goes on beyond the borders of its patch, periodically,
/// but for a wedge's two ends.
void relax(const Shape& shape, std::vector<Point>& points);

}  // namespace meniscus::benchmarks::quality
