// Step 2: the level that every base cell asks for, and the band of cells that the surface may pass.
#pragma once

#include <cstdint>

#include "lattice/host_device.hpp"
#include "meniscus/settings.hpp"
#include "stages/blocks.hpp"

namespace meniscus {

/// The paper's criterion: few particles in a cell are a splash, which needs the finest level.
/// A criterion is a callable from a block's number to its level, 1 to 3.
struct CountCriterion {
    const std::uint32_t* counts = nullptr;  ///< particles per block; adaptive SPH: those of level 0
    std::uint32_t threshold = 1;
    bool adaptive_sph = false;

    MENISCUS_HD int operator()(std::uint32_t block) const {
        const std::uint32_t count = counts[block];
        const bool fine = adaptive_sph ? count >= threshold : count >= 1 && count <= threshold;
        return fine ? 3 : 1;
    }
};

/// Marching cubes at the finest cell: the baseline.
struct UniformCriterion {
    MENISCUS_HD int operator()(std::uint32_t) const { return 3; }
};

struct BandTest {
    float iso = 0.0F;
    /// Corner values above this mean that nothing of the surface is inside the cell; found by experiment for the color
    /// field (0.85 at the threshold 0.6), infinite for the others.
    float deep_inside = 0.0F;

    /// corners: inside flags of the cell's eight corners. smallest: their smallest value. bound: no field value in
    /// the cell is above this.
    MENISCUS_HD bool may_hold_surface(int inside_corners, float smallest, float bound) const {
        if (inside_corners == 0) return bound > iso * 0.9999F;
        if (inside_corners == 8) return !(smallest > deep_inside);
        return true;
    }
};

}  // namespace meniscus
