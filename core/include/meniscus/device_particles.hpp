// Particles that are on the GPU already, of a simulator in the same process.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "meniscus/particle_frame.hpp"

namespace meniscus {

/// The arrays lie in memory of the reconstructor's GPU, device or managed, and stay as they are until the call returns.
/// No warning is given for a radius that does not fit their spacing.
struct DeviceParticleFrame {
    const float* positions = nullptr;      ///< x y z per particle, world units
    std::size_t count = 0;                 ///< particles
    const std::uint8_t* levels = nullptr;  ///< null (uniform SPH), or one per particle, 0 (finest) to 3
    void* stream = nullptr;  ///< the cudaStream_t on which they are made, null for CUDA's default one: the
                             ///< reconstruction waits for what is on it when it is called
    /// Arrays that the settings name become attributes of the mesh's vertices; their data are device pointers, aligned
    /// as their numbers are.
    std::span<const ParticleArray> arrays{};
};

}  // namespace meniscus
