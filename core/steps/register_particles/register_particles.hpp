// Step 1: which base cells the particles reach. (The paper's Step 1, Algorithm 1;
// core/README.md#step-1-register-particles)
#pragma once

#include <cstddef>
#include <cstdint>

#include "field/lanes.hpp"
#include "field/lattice_settings.hpp"
#include "lattice/brick_grid.hpp"
#include "lattice/coordinates.hpp"
#include "lattice/host_device.hpp"
#include "particles/particle_key.hpp"

namespace meniscus {

/// The bricks of base cells that particles in a support cell may reach: all from `low` to `high`.
struct ReachedBricks {
    Int3 low, high;
    MENISCUS_HD bool operator==(const ReachedBricks& o) const { return low == o.low && high == o.high; }
    MENISCUS_HD std::uint32_t count() const {
        return static_cast<std::uint32_t>(high.x - low.x + 1) * static_cast<std::uint32_t>(high.y - low.y + 1) *
               static_cast<std::uint32_t>(high.z - low.z + 1);
    }
};

/// 32 units more than the support, as ReachedBox widens it along x
/// (core/README.md#margins-of-registration-16-32-1).
MENISCUS_HD inline ReachedBricks reached_bricks(std::uint64_t cell_key, std::int64_t cell_units, float support) {
    constexpr std::int64_t edge = std::int64_t{units_per_base_cell} * brick_size;
    const std::int64_t reach = static_cast<std::int64_t>(support) + 32;
    const Units3 corner = cell_corner(cell_key, cell_units);
    const auto low = [&](std::int64_t p) { return static_cast<std::int32_t>(floor_div(p - reach, edge)); };
    const auto high = [&](std::int64_t p) {
        return static_cast<std::int32_t>(floor_div(p + cell_units + reach, edge));
    };
    return {{low(corner.x), low(corner.y), low(corner.z)}, {high(corner.x), high(corner.y), high(corner.z)}};
}

// A particle reaches the base cells whose closed box lies within its support. Position and support in units, relative
// to a brick's corner; rounded outward by 16 units, more than float32 can be off
// (core/README.md#margins-of-registration-16-32-1).

/// The cells of a brick that the cube around a particle's support meets, from `low` to `high`.
struct ReachedBox {
    int low[3], high[3];

    MENISCUS_HD ReachedBox(const float (&p)[3], float reach) {
        constexpr float edge = units_per_base_cell;
        for (int axis = 0; axis < 3; ++axis) {
            // A cell's closed box also touches the plane below it; a row may be found longer than it is.
            const float first = p[axis] - reach - (axis == 0 ? 16.0F : 1.0F);
            const float last = p[axis] + reach + (axis == 0 ? 16.0F : 0.0F);
            low[axis] = first < 0.0F ? 0 : static_cast<int>(first / edge);
            high[axis] = p[axis] + reach < 0.0F ? -1 : static_cast<int>(min(last / edge, float{brick_size - 1}));
        }
    }
    MENISCUS_HD bool empty() const { return low[0] > high[0] || low[1] > high[1] || low[2] > high[2]; }
    MENISCUS_HD std::uint32_t count() const {
        return static_cast<std::uint32_t>((high[0] - low[0] + 1) * (high[1] - low[1] + 1) * (high[2] - low[2] + 1));
    }
};

/// A row of a brick's cells from `first` to `last`, as bits.
MENISCUS_HD constexpr std::uint64_t row_bits(int first, int last) {
    return (std::uint64_t{2} << last) - (std::uint64_t{1} << first);
}

/// The distance of a place from the slice of cells i along an axis. F is float or Lanes.
template <class F>
MENISCUS_HD inline F gap_to_cells(float p, F i) {
    constexpr float edge = units_per_base_cell;
    const F low = i * F(edge);
    return max(max(low - F(p), F(p) - (low + F(edge))), F(0.0F));
}

/// The reached cells of rows along x, from `first` to `last` where they are whole numbers; none for lanes out of `set`.
template <class F>
struct ReachedRows {
    F first, last;
    unsigned set;

    /// x: the particle's place along the rows; gap_y, gap_z: its distances from them.
    MENISCUS_HD ReachedRows(float x, F gap_y, float gap_z, float reach) {
        constexpr float edge = units_per_base_cell;
        const F left = F(reach * reach - gap_z * gap_z) - gap_y * gap_y;
        const F span = sqrt(max(left, F(0.0F))) + F(16.0F);
        first = max(trunc((F(x) - span) / F(edge)), F(0.0F));
        last = min(trunc((F(x) + span) / F(edge)), F(float{brick_size - 1}));
        set = less_equal(F(0.0F), left) & less_equal(F(0.0F), F(x) + span) & less_equal(first, last);
    }
};

/// Pairs of a brick's base cells and particles near them, where only `members` of its cells are stored, by the sum of
/// ReachedBox::count(). are_few: LatticeSettings::leaves_cells_out().
MENISCUS_HD inline std::uint64_t pairs_in_brick(std::uint64_t marked, std::uint32_t members, bool are_few) {
    return are_few ? marked / brick_volume * members + marked % brick_volume * members / brick_volume : marked;
}

/// The base cells, as bits, of a row of a brick (y + 16 z) whose closed box touches the closed domain [low, high], in
/// cells.
MENISCUS_HD inline std::uint64_t row_in_domain(const Int3& brick, int row, const Int3& low, const Int3& high) {
    const auto beyond = [](std::int32_t cell, std::int32_t first, std::int32_t last) {
        return cell * base_cell_size > last || (cell + 1) * base_cell_size < first;
    };
    const Int3 first{brick.x * brick_size, brick.y * brick_size + (row & brick_axis_mask),
                     brick.z * brick_size + (row >> brick_axis_shift)};
    std::uint64_t cells = 0;
    if (!beyond(first.z, low.z, high.z) && !beyond(first.y, low.y, high.y))
        for (int x = 0; x < brick_size; ++x)
            if (!beyond(first.x + x, low.x, high.x)) cells |= std::uint64_t{1} << x;
    return cells;
}

/// The same for a word of Brick::occupied: four rows.
MENISCUS_HD inline std::uint64_t word_in_domain(const Int3& brick, int word, const Int3& low, const Int3& high) {
    std::uint64_t cells = 0;
    for (int i = 0; i < 4; ++i) cells |= row_in_domain(brick, 4 * word + i, low, high) << (brick_size * i);
    return cells;
}

/// The base cells of a word of Brick::occupied that may be stored, as bits.
MENISCUS_HD inline std::uint64_t storable_word(const LatticeSettings& settings, const Int3& brick, int word) {
    std::uint64_t cells = ~std::uint64_t{0};
    if (settings.has_domain) cells &= word_in_domain(brick, word, settings.domain_low, settings.domain_high);
    if (!settings.part.is_whole) cells &= settings.part.stored().word(brick, word);
    return cells;
}

}  // namespace meniscus
