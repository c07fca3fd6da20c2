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
    const float* fall;  ///< Poly6 only
    std::size_t count;
    float support;                 ///< of the level: none reaches farther; units
    float inverse_support;         ///< see inverse_support()
    const float* ranks = nullptr;  ///< see ParticleSetView; may be none
};

}  // namespace meniscus
