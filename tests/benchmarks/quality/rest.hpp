// Where the water of a frame rests, and how far its surface moves there.
#pragma once

#include <vector>

#include "compare/surface.hpp"
#include "quality/shapes.hpp"

namespace meniscus::benchmarks::quality {

struct Rest {
    std::vector<Point> places;  ///< on the surface, radii
    double share = 0.0;         ///< of the places that were looked at
};

/// Places spread over the surface around which no particle moves by more than a fifth of a radius until the next frame.
/// particles, next: the same particles in the same order, radii.
Rest find_rest(compare::SurfaceView surface, const std::vector<Point>& particles, const std::vector<Point>& next);

/// Rms distance of the places from a surface, radii; 0 without places.
double motion_at(const std::vector<Point>& places, compare::SurfaceView surface);

}  // namespace meniscus::benchmarks::quality
