// Coordinates far from the origin, which float32 does not hold as finely as near it.
#pragma once

#include <array>

#include "formats/meshes/triangle_mesh.hpp"
#include "formats/particles/particles.hpp"

namespace meniscus::editing {

/// World units.
using Origin = std::array<double, 3>;

/// Positions relative to the origin: those of the file, in float64, less the origin, rounded to float32 then.
void move_to(formats::Particles& particles, const Origin& origin);
/// The way back; files get float64 positions.
void move_from(formats::TriangleMesh& mesh, const Origin& origin);

/// By how much rounding has moved a particle along an axis, at most; world units.
double largest_remainder(const formats::Particles& particles);
/// The middle of the particles in whole world units, near which float32 is finest.
Origin middle_of(const formats::Particles& particles);

}  // namespace meniscus::editing
