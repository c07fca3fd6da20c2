// The rules about single particles, for frames that are checked where they lie.
#pragma once

#include <cstdint>

#include "meniscus/particle_frame.hpp"
#include "meniscus/settings.hpp"

namespace meniscus {

/// What validate() says of positions and levels alone. The frame's lengths are valid.
void validate_places(const ParticleFrame& frame, const Settings& settings);

/// How far from the origin a coordinate may be, world units.
double farthest_coordinate(const Settings& settings);

/// level: the greatest of the frame's, that of this particle. Throws InvalidInput if it cannot be.
void require_level(const Settings& settings, std::uint64_t particle, unsigned level);

/// coordinate: its index among all of the frame's, x y z per particle; value: it. Throws InvalidInput.
[[noreturn]] void refuse_coordinate(const Settings& settings, std::uint64_t coordinate, float value);

}  // namespace meniscus
