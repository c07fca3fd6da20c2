// A caller's particles as the library takes them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "meniscus/meniscus.h"
#include "meniscus/particle_frame.hpp"
#include "meniscus/parts.hpp"
#include "meniscus/strided_positions.hpp"

namespace meniscus::c {

/// Borrowed from the caller.
struct GivenParticles {
    StridedPositions positions;
    std::span<const std::uint8_t> levels;
    std::vector<ParticleArray> arrays;
};

/// Throws InvalidInput; what the particles are is for their receiver to check.
GivenParticles read_particles(const meniscus_particles* particles);

/// The values that a frame borrows from here, since the caller has them in another form. Keeps its memory.
struct FrameBuffers {
    std::vector<float> positions;  ///< where they must be converted
    std::vector<ParticleArray> arrays;
};

/// The particles as a frame, which borrows from the caller, and positions that must be converted from the buffers.
HandedFrame read_frame(const meniscus_particles* particles, FrameBuffers& buffers);

}  // namespace meniscus::c
