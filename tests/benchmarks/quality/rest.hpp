// Where the water of a frame rests, and how far its surface moves there against the water.
#pragma once

#include <vector>

#include "compare/surface.hpp"
#include "quality/shapes.hpp"

namespace meniscus::benchmarks::quality {

struct Rest {
    std::vector<Point> places;  ///< radii, on the surface and carried along with the water to the next frame
    double share = 0.0;         ///< share of the places that were looked at
};

/// Places spread over the surface around which the water keeps its shape until the next frame: it rests, or moves as a
/// whole, with no particle within 6 r more than 0.3 r off the mean movement. particles, next: the same particles in the
/// same order, radii.
Rest find_rest(compare::SurfaceView surface, const std::vector<Point>& particles, const std::vector<Point>& next);

/// Rms distance of the places from a surface, radii; 0 without places.
double motion_at(const std::vector<Point>& places, compare::SurfaceView surface);

}  // namespace meniscus::benchmarks::quality
