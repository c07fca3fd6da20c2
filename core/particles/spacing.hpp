// The radius that fits the particles of a frame, by how far apart they lie.
#pragma once

#include <optional>

#include "meniscus/particle_frame.hpp"

namespace meniscus {

/// What fits where a given radius does not.
struct FittingRadius {
    double radius = 0.0;  ///< of level 0, world units, to two digits
    /// The share of the particles that touch no other at the given radius, where they lie scattered; 0 where they are
    /// water.
    double alone = 0.0;
};

/// None where the given radius is less than about twice too small or too large, and where the frame does not show it:
/// fewer than 100 particles, water among spray, particles in one place. The frame is valid. The reasons and the
/// constants: core/README.md#warnings.
std::optional<FittingRadius> radius_that_fits(const ParticleFrame& frame, double radius);

}  // namespace meniscus
