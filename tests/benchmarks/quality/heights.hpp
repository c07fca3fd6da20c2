// The height of a surface, seen from above.
#pragma once

#include <vector>

#include "compare/surface.hpp"
#include "quality/shapes.hpp"

namespace meniscus::benchmarks::quality {

/// z of the highest point of the surface at places spread evenly over the rectangle, in rows; minus infinity where
/// there is none. All in radii.
std::vector<double> heights_of(compare::SurfaceView surface, const Rectangle& over);

/// Rms difference of the heights of two surfaces, radii. Throws InvalidInput if one does not cover the rectangle.
double height_motion(compare::SurfaceView from, compare::SurfaceView to, const Rectangle& over);

}  // namespace meniscus::benchmarks::quality
