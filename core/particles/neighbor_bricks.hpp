// The bricks of particles near each brick of base cells, found once for a frame.
#pragma once

#include "lattice/brick_grid.hpp"
#include "particles/particle_set.hpp"

namespace meniscus::cuda {

/// The bricks of one level of particles around one brick of base cells. A brick of particles is at least as wide as one
/// of base cells, and 16 times as wide as particles reach: those that reach one brick of base cells lie in three a
/// side.
struct NeighborBricks {
    static constexpr int a_side = 3;
    static constexpr int slots = a_side * a_side * a_side;

    std::int32_t corner[3];      ///< corner of slot 0's brick, units from the corner of the brick of base cells
    float cells_per_unit;        ///< 1 / the edge of a support cell
    std::uint32_t brick[slots];  ///< index in the level's set at x + 3 y + 9 z; no_index where there is no brick

    /// The coordinate of slot 0's brick.
    MENISCUS_HD static Int3 lowest(const ParticleSetView& set, const Units3& origin) {
        const auto reached = static_cast<std::int64_t>(floorf(0.0F - set.support));
        return brick_of(set.cell_of(origin.x + reached, origin.y + reached, origin.z + reached));
    }
    MENISCUS_HD static Int3 offset(int slot) {
        return {slot % a_side, slot / a_side % a_side, slot / (a_side * a_side)};
    }
    /// offset: from slot 0, 0 to 2 a side.
    MENISCUS_HD std::uint32_t at(const Int3& offset) const {
        return brick[offset.x + a_side * offset.y + a_side * a_side * offset.z];
    }
};

}  // namespace meniscus::cuda
