// Step 1: which base cells the particles reach. (The paper's Step 1, Algorithm 1;
// core/README.md#step-1-register-particles)
#pragma once

#include <cstddef>
#include <cstdint>

#include "field/lanes.hpp"
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

/// 32 units more than the support, as mark_reached() widens it along x
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

/// Marks in a brick that one thread alone works on.
struct BrickMarks {
    Brick& brick;
    MENISCUS_HD std::uint64_t word(int w) const { return brick.occupied[w]; }
    MENISCUS_HD void add(int w, std::uint64_t cells) const { brick.occupied[w] |= cells; }
};

/// Marks the base cells of a brick whose closed box lies within a particle's support. Position and support in units,
/// relative to the brick's corner; rounded outward by 16 units, more than float32 can be off
/// (core/README.md#margins-of-registration-16-32-1). marks: word(w) reads a word of Brick::occupied, add(w, cells) adds
/// to it.
/// Returns how many there are at most: those of the brick that the cube around the support meets.
template <class Marks>
MENISCUS_HD inline std::uint32_t mark_reached(const Marks& marks, float x, float y, float z, float support) {
    constexpr float edge = units_per_base_cell;
    const float reach = support + 16.0F;
    const auto first = [&](float p) {
        const auto i = static_cast<int>(p / edge);
        return p < 0.0F ? 0 : i;
    };
    const auto last = [&](float p) {
        const auto i = static_cast<int>(p / edge);
        return i > brick_size - 1 ? brick_size - 1 : i;
    };
    // A cell's closed box also touches the plane below it.
    const auto gap = [&](float p, int i) {
        const float low = static_cast<float>(i) * edge;
        return max(max(low - p, p - (low + edge)), 0.0F);
    };
    if (z + reach < 0.0F || y + reach < 0.0F || x + reach < 0.0F) return 0;
    const int z0 = first(z - reach - 1.0F);
    const int z1 = last(z + reach);
    const int y0 = first(y - reach - 1.0F);
    const int y1 = last(y + reach);
    const int x_low = first(x - (reach + 16.0F));
    const int x_high = last(x + (reach + 16.0F));
    if (x_low > x_high || y0 > y1 || z0 > z1) return 0;
    // Most particles lie among others: rows that those have marked are passed over, four at a time.
    const std::uint64_t widest = ((std::uint64_t{2} << x_high) - (std::uint64_t{1} << x_low)) * first_of_rows;
    for (int cz = z0; cz <= z1; ++cz) {
        const float dz = gap(z, cz);
        for (int rows = y0 & ~3; rows <= y1; rows += 4) {
            const int w = rows >> 2 | cz << 2;
            const std::uint64_t occupied = marks.word(w);
            if ((widest & ~occupied) == 0) continue;
            std::uint64_t reached = 0;
            const int y_end = y1 < rows + 3 ? y1 : rows + 3;
            for (int cy = y0 > rows ? y0 : rows; cy <= y_end; ++cy) {
                const int row = (cy & 3) << 4;
                if ((widest & ~occupied) >> row << 48 == 0) continue;
                const float dy = gap(y, cy);
                const float left = reach * reach - dz * dz - dy * dy;
                if (left < 0.0F) continue;
                const float span = sqrt(left) + 16.0F;
                if (x + span < 0.0F) continue;
                const int x0 = first(x - span);
                const int x1 = last(x + span);
                if (x0 > x1) continue;
                reached |= ((std::uint64_t{2} << x1) - (std::uint64_t{1} << x0)) << row;
            }
            marks.add(w, reached);
        }
    }
    return static_cast<std::uint32_t>((x_high - x_low + 1) * (y1 - y0 + 1) * (z1 - z0 + 1));
}

/// Pairs of a brick's base cells and particles near them, where only `members` of its cells are stored, by the sum of
/// what mark_reached() returned. A domain leaves cells out however near particles are.
MENISCUS_HD inline std::uint64_t pairs_in_brick(std::uint64_t marked, std::uint32_t members, bool has_domain) {
    return has_domain ? marked / brick_volume * members + marked % brick_volume * members / brick_volume : marked;
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

}  // namespace meniscus
