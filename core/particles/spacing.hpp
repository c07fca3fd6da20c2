// The radius that fits the particles of a frame, by how far apart they lie.
#pragma once

#include <optional>

#include "meniscus/particle_frame.hpp"

namespace meniscus {

/// The radius of level 0, world units, to two digits; none where the given radius is less than about twice too small or
/// too large, and where the frame does not show it: fewer than 100 particles, spray, particles in one place. The frame
/// is valid. The reasons and the constants: core/README.md#warnings.
std::optional<double> radius_that_fits(const ParticleFrame& frame, double radius);

}  // namespace meniscus
