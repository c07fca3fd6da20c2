// A caller's particles as the library takes them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "meniscus/meniscus.h"
#include "meniscus/particle_frame.hpp"
#include "meniscus/strided_positions.hpp"

namespace meniscus::c {

/// Borrowed from the caller.
struct GivenParticles {
    StridedPositions positions;
    std::span<const std::uint8_t> levels;
};

/// Throws InvalidInput; what the particles are is for their receiver to check.
GivenParticles read_particles(const meniscus_particles* particles);

/// As a frame, which borrows from the caller, or from `buffer` where positions must be converted.
ParticleFrame read_frame(const meniscus_particles* particles, std::vector<float>& buffer);

}  // namespace meniscus::c
