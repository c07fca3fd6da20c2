// The distance from one surface to another.
#pragma once

#include <vector>

#include "compare/samples.hpp"
#include "compare/triangle_tree.hpp"

namespace meniscus::compare {

/// Distances of the samples of a surface, weighted by area; world units.
struct DistanceSummary {
    double rms = 0.0;
    double percentile_99 = 0.0;
    double max = 0.0;
};

struct SurfaceDistance {
    DistanceSummary summary;
    std::vector<double> nearest;  ///< per component: the distance of its nearest sample, world units
};

/// From the samples of one surface to the other surface.
SurfaceDistance measure(const Samples& from, const TriangleTree& to);

}  // namespace meniscus::compare
