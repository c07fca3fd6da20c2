// The particles of one level, sorted by cells of their support's size, and the search for those near a box.
#pragma once

#include <cmath>
#include <cstdint>

#include "field/poly6.hpp"
#include "lattice/brick_grid.hpp"
#include "lattice/coordinates.hpp"
#include "lattice/host_device.hpp"

namespace meniscus {

/// A box in units, relative to some origin.
struct UnitBox {
    float low[3];
    float high[3];
};

/// Coordinates in units from the corner of the particle's support cell's brick: exact in float32.
struct ParticleSetView {
    BrickGridView cells;
    const std::uint32_t* first = nullptr;  ///< first particle of each cell, and one past the last
    const float* x = nullptr;
    const float* y = nullptr;
    const float* z = nullptr;
    const float* weight = nullptr;  ///< weight of each kernel, see CubicSpline and Poly6
    const float* fall = nullptr;    ///< fall of each kernel; Poly6 only, else null
    std::int64_t cell_units = 0;    ///< edge of a support cell
    float support = 0.0F;           ///< h, or the widest of the particles; units
    /// Each particle's place in the set, as the bits of a float; null where ranks are not needed.
    const float* ranks = nullptr;

    MENISCUS_HD Int3 cell_of(std::int64_t px, std::int64_t py, std::int64_t pz) const {
        return {static_cast<std::int32_t>(floor_div(px, cell_units)),
                static_cast<std::int32_t>(floor_div(py, cell_units)),
                static_cast<std::int32_t>(floor_div(pz, cell_units))};
    }

    /// The distance from which particle i adds nothing, units.
    MENISCUS_HD float support_of(std::uint32_t i) const {
        return fall == nullptr ? support : Poly6{weight[i], fall[i]}.support();
    }

    /// Particles farther from a box than this may be passed over. A little more than the support, since a rounded
    /// distance just below it still adds a tiny term.
    MENISCUS_HD float reach() const { return reach_of(support); }
    MENISCUS_HD static float reach_of(float support) { return support + 1.0F; }

    /// Calls visit(first particle, one past the last, shift) for runs of particles, in their order, that hold all those
    /// within reach of the box. A particle's position plus shift (x, y, z) is relative to `origin`, a multiple of 16
    /// units.
    template <class Hints, class Visit>
    MENISCUS_HD void for_each_run_near(const Units3& origin, const UnitBox& box, Hints& hints, Visit&& visit) const {
        // Positions are whole units: one that is a support away or farther along an axis adds exactly zero.
        const auto below = [this](float v) { return static_cast<std::int64_t>(floorf(v - support)); };
        const auto above = [this](float v) { return static_cast<std::int64_t>(ceilf(v + support)) - 1; };
        const Int3 low =
            cell_of(origin.x + below(box.low[0]), origin.y + below(box.low[1]), origin.z + below(box.low[2]));
        const Int3 high =
            cell_of(origin.x + above(box.high[0]), origin.y + above(box.high[1]), origin.z + above(box.high[2]));
        const std::int64_t edge = cell_units * brick_size;
        cells.for_each_brick(low, high, hints, [&](const Brick& brick, const Int3& first_cell, const Int3& last_cell) {
            const float shift[3] = {static_cast<float>(brick.coordinate.x * edge - origin.x),
                                    static_cast<float>(brick.coordinate.y * edge - origin.y),
                                    static_cast<float>(brick.coordinate.z * edge - origin.z)};
            brick.for_each_run(first_cell, last_cell, [&](std::uint32_t cell, std::uint32_t count) {
                visit(first[cell], first[cell + count], shift);
            });
        });
    }

    /// Calls visit(x, y, z, particle) for all particles of those runs, relative to `origin`.
    template <class Visit>
    MENISCUS_HD void for_each_near(const Units3& origin, const UnitBox& box, Visit&& visit) const {
        BrickHints hints;
        for_each_run_near(origin, box, hints, [&](std::uint32_t begin, std::uint32_t end, const float* shift) {
            for (std::uint32_t i = begin; i < end; ++i) visit(x[i] + shift[0], y[i] + shift[1], z[i] + shift[2], i);
        });
    }
};

}  // namespace meniscus
