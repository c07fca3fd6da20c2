// The smooth field's constants.
#pragma once

#include <array>
#include <cstdint>

#include "meniscus/particle_frame.hpp"

namespace meniscus {

/// Each is found by an experiment (core/README.md#the-smooth-field). Lengths in radii of the particle's level.
struct SmoothField {
    float lone_support = 3.0F;     ///< of a particle alone
    float widest_support = 0.0F;   ///< of a particle among others
    float company_support = 0.0F;  ///< within which others count as company, and as density
    float least_company = 0.25F;   ///< others than itself; below it a particle is alone
    float full_company = 1.75F;    ///< above it a particle is among others
    float least_value = 0.75F;     ///< of the field at a particle's place, before `factor`
    float iso = 0.6F;              ///< the threshold for which the constants were found
    float deep_inside = 0.0F;      ///< see BandTest, for that threshold
    std::array<float, max_particle_level + 1> units_per_radius{};

    /// smoothness: as in Settings.
    explicit SmoothField(std::uint32_t smoothness = 6, double cell_size = 1.0);
};

}  // namespace meniscus
