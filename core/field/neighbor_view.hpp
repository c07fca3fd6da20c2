// Particles to be summed over.
#pragma once

#include <cstddef>

namespace meniscus {

/// Neighbors of one level, borrowed.
struct NeighborView {
    const float* x;
    const float* y;
    const float* z;
    const float* weight;
    const float* fall;  ///< fall of each; Poly6 only, else null
    std::size_t count;
    float support;                 ///< support of the level: no particle reaches farther; units
    float inverse_support;         ///< 1 / support, see inverse_support()
    const float* ranks = nullptr;  ///< ranks of ParticleSetView; may be null
};

}  // namespace meniscus
