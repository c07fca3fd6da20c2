// How rough a surface is where the true one is not known.
#pragma once

#include "compare/surface.hpp"

namespace meniscus::benchmarks::quality {

/// Angles between a triangle's normal and the mean normal of the triangles around it, degrees.
struct Roughness {
    double rms = 0.0;     ///< over the area
    double median = 0.0;  ///< over the area
};

/// Of the triangles that face up (y), away from the walls at the ends of the surface's extent in x and z. surface: in
/// radii, with at least one such triangle.
Roughness roughness_of(compare::SurfaceView surface);

}  // namespace meniscus::benchmarks::quality
