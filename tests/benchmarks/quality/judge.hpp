// How far a surface is from the one that its particles stand for.
#pragma once

#include <span>

#include "compare/surface.hpp"
#include "quality/shapes.hpp"

namespace meniscus::benchmarks::quality {

/// Means are over the surface's area. Lengths in radii; positive is outside of the shape.
struct Deviation {
    double offset = 0.0;            ///< mean of the signed distances of the triangles' centers from the true surface
    double rms = 0.0;               ///< rms of the same, without their mean
    double worst = 0.0;             ///< the largest distance of a vertex
    double degrees = 0.0;           ///< rms angle between the normal at a vertex and the true one next to it
    double triangle_degrees = 0.0;  ///< the same of the triangles' own normals, at their centers
    double volume = 0.0;            ///< enclosed, over the shape's; of a layer: in the judged part, under its area
    double particle_volume = 0.0;   ///< enclosed by the whole surface, over that of all particles
};

/// surface: in radii, with at least one triangle in the judged part. normals: empty, or one per vertex. particles:
/// their number.
Deviation judge(const Shape& shape, compare::SurfaceView surface, std::span<const Normal> normals,
                std::size_t particles);

/// The true thickness of a layer that thins out where its surface ends, radii: over its judged part, the surface covers
/// as much as if it ended there in a straight line.
double thickness_at_end(const Layer& layer, compare::SurfaceView surface);

/// Enclosed by a closed surface, in its own units cubed.
double enclosed_volume(compare::SurfaceView surface);

}  // namespace meniscus::benchmarks::quality
