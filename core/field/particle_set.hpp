// The particles of one level, sorted by cells of their support's size, and the search for those near a box.
#pragma once

#include <cmath>
#include <cstdint>

#include "field/lanes.hpp"
#include "lattice/brick_grid.hpp"
#include "lattice/coordinates.hpp"
#include "lattice/host_device.hpp"

namespace meniscus {

/// Position in units from the corner of its support cell's brick: exact in float32.
struct Particle {
    float x, y, z;
    float weight;  ///< mass (color: mass over density) times the kernel's W0
};

/// A box in units, relative to some origin.
struct UnitBox {
    float low[3];
    float high[3];
};

/// The edge of support cells: at least the support (so that a point's neighbors lie in 27 cells), at least a base cell
/// (so that keys fit), and a multiple of 16 (so that the distance of two brick corners is exact in float32).
MENISCUS_HD constexpr std::int64_t support_cell_units(std::int64_t support_units) {
    const std::int64_t edge = support_units > units_per_base_cell ? support_units : units_per_base_cell;
    return (edge + 15) / 16 * 16;
}

struct ParticleSetView {
    BrickGridView cells;
    const std::uint32_t* first = nullptr;  ///< first particle of each cell, and one past the last
    const Particle* particles = nullptr;
    std::int64_t cell_units = 0;           ///< edge of a support cell
    float support = 0.0F;                  ///< h, units

    MENISCUS_HD Int3 cell_of(std::int64_t x, std::int64_t y, std::int64_t z) const {
        return {static_cast<std::int32_t>(floor_div(x, cell_units)), static_cast<std::int32_t>(floor_div(y, cell_units)),
                static_cast<std::int32_t>(floor_div(z, cell_units))};
    }

    /// Calls visit(x, y, z, weight), in the order of the particles, for every particle that may reach into the box;
    /// positions are relative to `origin` (a multiple of 16 units). Particles beyond are culled with a margin, since a
    /// rounded distance just below the support still adds a tiny term.
    template <class Visit>
    MENISCUS_HD void for_each_near(const Units3& origin, const UnitBox& box, Visit&& visit) const {
        // Positions are whole units: one that is a support away or farther along an axis adds exactly zero.
        const auto below = [this](float v) { return static_cast<std::int64_t>(floorf(v - support)); };
        const auto above = [this](float v) { return static_cast<std::int64_t>(ceilf(v + support)) - 1; };
        const Int3 low = cell_of(origin.x + below(box.low[0]), origin.y + below(box.low[1]), origin.z + below(box.low[2]));
        const Int3 high = cell_of(origin.x + above(box.high[0]), origin.y + above(box.high[1]), origin.z + above(box.high[2]));
        const float reach2 = (support + 1.0F) * (support + 1.0F);
        cells.for_each_run(low, high, [&](std::uint32_t brick, std::uint32_t cell, std::uint32_t count) {
            const Int3 corner = cells.bricks[brick].coordinate;
            const std::int64_t edge = cell_units * brick_size;
            const float shift_x = static_cast<float>(corner.x * edge - origin.x);
            const float shift_y = static_cast<float>(corner.y * edge - origin.y);
            const float shift_z = static_cast<float>(corner.z * edge - origin.z);
            const std::uint32_t end = first[cell + count];
            for (std::uint32_t i = first[cell]; i < end; ++i) {
                const Particle p = particles[i];
                const float x = p.x + shift_x;
                const float y = p.y + shift_y;
                const float z = p.z + shift_z;
                const float dx = larger(larger(box.low[0] - x, x - box.high[0]), 0.0F);
                const float dy = larger(larger(box.low[1] - y, y - box.high[1]), 0.0F);
                const float dz = larger(larger(box.low[2] - z, z - box.high[2]), 0.0F);
                if (dx * dx + dy * dy + dz * dz <= reach2) visit(x, y, z, p.weight);
            }
        });
    }
};

}  // namespace meniscus
