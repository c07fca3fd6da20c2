// Step 1: particles are snapped to the lattice, sorted, and registered in the base cells that they lie in and reach.
#pragma once

#include <cstdint>

#include "field/lanes.hpp"
#include "field/particle_set.hpp"
#include "lattice/brick_grid.hpp"
#include "lattice/coordinates.hpp"
#include "lattice/host_device.hpp"

namespace meniscus {

/// Where a particle stands in the one order in which the field is summed: by brick of support cells, by support cell, by
/// position. Two particles with the same key are the same.
struct ParticleKey {
    std::uint64_t cell;   ///< brick (z, y, x), then index_in_brick
    std::uint64_t place;  ///< units from the cell's corner: z, y, x, 21 bits each

    MENISCUS_HD bool operator<(const ParticleKey& o) const { return cell != o.cell ? cell < o.cell : place < o.place; }
};

inline constexpr int brick_axis_bits = 17;  ///< support cells are no smaller than base cells
inline constexpr int place_axis_bits = 21;
static_assert(std::int64_t{max_support_cells} * units_per_cell < (std::int64_t{1} << place_axis_bits));

MENISCUS_HD inline ParticleKey particle_key(const Units3& p, std::int64_t cell_units) {
    constexpr std::int64_t bias = std::int64_t{1} << (brick_axis_bits - 1);
    const Int3 cell{static_cast<std::int32_t>(floor_div(p.x, cell_units)), static_cast<std::int32_t>(floor_div(p.y, cell_units)),
                    static_cast<std::int32_t>(floor_div(p.z, cell_units))};
    const Int3 brick = brick_of(cell);
    const std::int64_t bricks = ((brick.z + bias) << brick_axis_bits | (brick.y + bias)) << brick_axis_bits | (brick.x + bias);
    const std::int64_t place = ((p.z - cell.z * cell_units) << place_axis_bits | (p.y - cell.y * cell_units)) << place_axis_bits |
                               (p.x - cell.x * cell_units);
    return {static_cast<std::uint64_t>(bricks << 12 | index_in_brick(cell)), static_cast<std::uint64_t>(place)};
}

MENISCUS_HD inline Int3 key_brick(std::uint64_t cell_key) {
    constexpr std::int64_t mask = (std::int64_t{1} << brick_axis_bits) - 1;
    constexpr std::int32_t bias = 1 << (brick_axis_bits - 1);
    const auto bricks = static_cast<std::int64_t>(cell_key >> 12);
    return {static_cast<std::int32_t>(bricks & mask) - bias, static_cast<std::int32_t>(bricks >> brick_axis_bits & mask) - bias,
            static_cast<std::int32_t>(bricks >> (2 * brick_axis_bits)) - bias};
}
MENISCUS_HD inline int key_index(std::uint64_t cell_key) { return static_cast<int>(cell_key & 0xFFF); }

/// A key's position, in units from the corner of its support cell's brick.
MENISCUS_HD inline void key_position(const ParticleKey& key, std::int64_t cell_units, float& x, float& y, float& z) {
    constexpr std::uint64_t mask = (std::uint64_t{1} << place_axis_bits) - 1;
    const int index = key_index(key.cell);
    const auto coordinate = [&](int in_brick, std::uint64_t in_cell) {
        return static_cast<float>(in_brick * cell_units + static_cast<std::int64_t>(in_cell & mask));
    };
    x = coordinate(index & 15, key.place);
    y = coordinate(index >> 4 & 15, key.place >> place_axis_bits);
    z = coordinate(index >> 8, key.place >> (2 * place_axis_bits));
}

/// Marks the base cells of a brick whose closed box lies within a particle's support. Position and support in units, relative to
/// the brick's corner; rounded outward by some units.
MENISCUS_HD inline void mark_reached(Brick& brick, float x, float y, float z, float support) {
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
        return larger(larger(low - p, p - (low + edge)), 0.0F);
    };
    if (z + reach < 0.0F || y + reach < 0.0F || x + reach < 0.0F) return;
    const int z0 = first(z - reach - 1.0F);
    const int z1 = last(z + reach);
    const int y0 = first(y - reach - 1.0F);
    const int y1 = last(y + reach);
    const int x_low = first(x - (reach + 16.0F));
    const int x_high = last(x + (reach + 16.0F));
    if (x_low > x_high) return;
    // Most particles lie among others: rows that those have marked are passed over, four at a time.
    const std::uint64_t widest = ((std::uint64_t{2} << x_high) - (std::uint64_t{1} << x_low)) * 0x0001000100010001ULL;
    for (int cz = z0; cz <= z1; ++cz) {
        const float dz = gap(z, cz);
        for (int rows = y0 & ~3; rows <= y1; rows += 4) {
            std::uint64_t& occupied = brick.occupied[rows >> 2 | cz << 2];
            if ((widest & ~occupied) == 0) continue;
            const int y_end = y1 < rows + 3 ? y1 : rows + 3;
            for (int cy = y0 > rows ? y0 : rows; cy <= y_end; ++cy) {
                const int row = (cy & 3) << 4;
                if ((widest & ~occupied) >> row << 48 == 0) continue;
                const float dy = gap(y, cy);
                const float left = reach * reach - dz * dz - dy * dy;
                if (left < 0.0F) continue;
                const float span = root(left) + 16.0F;
                if (x + span < 0.0F) continue;
                const int x0 = first(x - span);
                const int x1 = last(x + span);
                if (x0 > x1) continue;
                occupied |= ((std::uint64_t{2} << x1) - (std::uint64_t{1} << x0)) << row;
            }
        }
    }
}

/// Unmarks the base cells of a brick whose closed box does not touch the closed domain [low, high], in cells.
MENISCUS_HD inline void clear_beyond_domain(Brick& brick, const Int3& low, const Int3& high) {
    const auto beyond = [](std::int32_t cell, std::int32_t first, std::int32_t last) {
        return cell * base_cell_size > last || (cell + 1) * base_cell_size < first;
    };
    const Int3 corner{brick.coordinate.x * brick_size, brick.coordinate.y * brick_size, brick.coordinate.z * brick_size};
    for (int z = 0; z < brick_size; ++z)
        for (int y = 0; y < brick_size; ++y) {
            std::uint64_t keep = 0;
            if (!beyond(corner.z + z, low.z, high.z) && !beyond(corner.y + y, low.y, high.y))
                for (int x = 0; x < brick_size; ++x)
                    if (!beyond(corner.x + x, low.x, high.x)) keep |= std::uint64_t{1} << x;
            const int row = y << 4 | z << 8;
            brick.occupied[row >> 6] &= ~(std::uint64_t{0xFFFF} << (row & 63)) | keep << (row & 63);
        }
}

}  // namespace meniscus
