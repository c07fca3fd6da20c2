// The user's settings in the lattice's terms.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "lattice/coordinates.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/settings.hpp"

namespace meniscus {

inline constexpr unsigned particle_level_count = max_particle_level + 1;

struct LatticeSettings {
    double cell_size = 0.0;                             ///< c, world units
    double units_per_length = 0.0;                      ///< 4096 / c
    std::array<float, particle_level_count> support{};  ///< h of each particle level, units
    /// m / rho0 times the kernel's W0 = 16 / (pi h^3): both scale with 2^3k, so that all particle levels share it.
    float weight = 0.0F;
    float iso = 0.0F;
    float deep_inside = std::numeric_limits<float>::infinity();  ///< see BandTest
    float blob_closest = 0.75F;                                  ///< see BlobRule
    int blob_level = 2;
    std::uint32_t offset_bits = 6;
    bool has_domain = false;
    Int3 domain_low, domain_high;  ///< in cells, rounded outward

    /// The settings must be valid.
    explicit LatticeSettings(const Settings& settings);
};

}  // namespace meniscus
