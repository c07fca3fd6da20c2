// The smooth field's constants.
#pragma once

#include <array>
#include <cstdint>

#include "meniscus/particle_frame.hpp"

namespace meniscus {

/// Each is found by an experiment (core/README.md#the-smooth-field). Lengths in radii of the particle's level.
struct SmoothField {
    float lone_support = 3.12F;    ///< support of a particle alone
    float widest_support = 0.0F;   ///< support of a particle among others
    float company_support = 0.0F;  ///< distance within which others count as company, and as density
    float least_company = 0.25F;   ///< company beside itself; below it a particle is alone
    float full_company = 1.75F;    ///< company above which a particle is among others
    float shared_drop = 0.3F;      ///< loss of volume by company, for a particle that counts as alone
    float least_value = 0.0F;      ///< least value of the field at a particle's place, at the threshold 0.6; 1 at 1
    // A group of few particles nearer to each other than at rest is lifted more, or it would shrink to a few of them.
    float group_size = 2.5F;     ///< number of particles within the support above which the kernel is lifted
    float group_spread = 0.66F;  ///< company, for each of these, below which the kernel is lifted
    float group_lift = 0.0F;     ///< lift for the product of both excesses
    float deep_inside = 0.0F;    ///< value of deep cells, see BandTest; at the threshold 0.6
    std::array<float, max_particle_level + 1> units_per_radius{};

    /// smoothness: as in Settings. cell_size: radii.
    explicit SmoothField(std::uint32_t smoothness = 6, double cell_size = 1.0);
};

}  // namespace meniscus
