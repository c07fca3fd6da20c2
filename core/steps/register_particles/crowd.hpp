// The limit to how densely particles may lie.
#pragma once

#include <cstdint>
#include <string>

#include "field/lattice_settings.hpp"
#include "lattice/host_device.hpp"
#include "meniscus/error.hpp"

namespace meniscus {

/// The most particles that may share a support cell, in the mean over the particles. Water has 8; the sums of a frame
/// in the wrong unit, or with all its particles in one place, would take hours (core/README.md#crowds-1024-and-16384).
inline constexpr double most_crowded = 1024.0;

/// Whether the same mean is above the limit, for frames of any size. crowd: the sum of the squares of the cells'
/// numbers of particles.
MENISCUS_HD inline bool is_crowded(std::uint64_t crowd, std::uint64_t particles, const LatticeSettings& settings) {
    constexpr std::uint64_t small = 16384;
    // Support cells are as large as base cells where those are larger than the support.
    const double cell = static_cast<double>(units_per_base_cell) / static_cast<double>(settings.support[0]);
    const double room = cell > 1.0 ? cell * cell * cell : 1.0;
    return static_cast<double>(crowd) >
           most_crowded * room * static_cast<double>(particles < small ? small : particles);
}

/// The refusal of a frame that is_crowded(), to which the reconstructor adds the radius that fits.
class Crowded : public LimitExceeded {
public:
    using LimitExceeded::LimitExceeded;
};

[[noreturn]] inline void throw_crowded(std::uint64_t crowd, std::uint64_t particles) {
    throw Crowded("a particle shares its surroundings of one kernel support with " + std::to_string(crowd / particles) +
                  " others in the mean, far more than the field can be summed over (about " +
                  std::to_string(static_cast<int>(most_crowded)) +
                  "): are the positions in the unit of the particle radius, and not all in one place?");
}

}  // namespace meniscus
