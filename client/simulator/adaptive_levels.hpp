// Particles of two sizes for adaptive SPH, from a simulation with one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "simulator/boundary.hpp"

namespace meniscus::simulator {

struct LeveledParticles {
    std::vector<float> positions;        ///< x y z per particle, meters
    std::vector<std::uint8_t> levels{};  ///< 0, or 1 for a particle of twice the radius and eight times the mass
    /// Of a particle of level 0 the one that it was; of one of level 1 the eight that it was made of, which come
    /// behind. Empty: all are as they were.
    std::vector<std::uint32_t> sources{};

    /// Transfers per-particle values, `components` numbers each, to the new particles: those of level 1 get the mean.
    std::vector<float> merged(const std::vector<float>& values, std::size_t components) const;
};

/// The simulation itself is uniform; this merges what it computed, for the upload: in every cell of 2 x 2 x 2 rest
/// distances whose 26 neighbors are filled too, the eight particles nearest to the cell's center become one of level 1
/// at their center of mass. So everything within 4 radii of the water's surface, at the walls too, keeps level 0, and
/// mass and center of mass are kept. positions: x y z per particle; they lie in the tank.
LeveledParticles merge_deep_particles(std::span<const float> positions, float particle_radius, const Tank& tank);

}  // namespace meniscus::simulator
