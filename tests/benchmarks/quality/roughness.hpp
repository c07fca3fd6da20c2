// How rough a surface is where the true one is not known.
#pragma once

#include "compare/surface.hpp"

namespace meniscus::benchmarks::quality {

/// Angles between the normal at a vertex, by its triangles, and the mean normal within 5 r of it, degrees.
struct Roughness {
    double rms = 0.0;     ///< over the area
    double median = 0.0;  ///< over the area
};

/// The roughness at the vertices that face up (y), farther than 10 r from the walls at the ends of the surface's extent
/// in x and z. surface: in radii, with at least one such vertex.
Roughness roughness_of(compare::SurfaceView surface);

}  // namespace meniscus::benchmarks::quality
