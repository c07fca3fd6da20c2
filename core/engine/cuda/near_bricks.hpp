// The bricks of particles near each brick of base cells, found once for a frame.
#pragma once

#include "lattice/brick_grid.hpp"
#include "particles/particle_set.hpp"

namespace meniscus::cuda {

/// Of one level of particles, around one brick of base cells. A brick of particles is at least as wide as one of base
/// cells, and 16 times as wide as particles reach: those that reach one brick of base cells lie in three a side.
struct NearBricks {
    static constexpr int a_side = 3;
    static constexpr int slots = a_side * a_side * a_side;

    Int3 lowest;                 ///< coordinate of slot 0's brick
    std::uint32_t brick[slots];  ///< index in the level's set at x + 3 y + 9 z from there; no_index where there is none

    /// For boxes within this brick of base cells.
    MENISCUS_HD static Int3 lowest_near(const ParticleSetView& set, const Brick& of) {
        const Units3 origin = base_cell_origin(of.corner());
        const auto below = [&](std::int64_t at) { return at + static_cast<std::int64_t>(floorf(0.0F - set.support)); };
        return brick_of(set.cell_of(below(origin.x), below(origin.y), below(origin.z)));
    }
    MENISCUS_HD static Int3 offset(int slot) {
        return {slot % a_side, slot / a_side % a_side, slot / (a_side * a_side)};
    }
    MENISCUS_HD std::uint32_t at(const Int3& coordinate) const {
        const Int3 from_lowest = coordinate - lowest;
        return brick[from_lowest.x + a_side * from_lowest.y + a_side * a_side * from_lowest.z];
    }
};

}  // namespace meniscus::cuda
