// A particle as a sort key, from which its position can be read back: where only positions matter, sorting the keys is
// all there is to sort.
#pragma once

#include <cstdint>

#include "lattice/brick_grid.hpp"
#include "lattice/coordinates.hpp"
#include "lattice/host_device.hpp"

namespace meniscus {

/// The place of a particle in the one order in which the field is summed: by brick of support cells, by support cell,
/// by position. Two particles with the same key are the same.
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
    const Int3 cell{static_cast<std::int32_t>(floor_div(p.x, cell_units)),
                    static_cast<std::int32_t>(floor_div(p.y, cell_units)),
                    static_cast<std::int32_t>(floor_div(p.z, cell_units))};
    const Int3 brick = brick_of(cell);
    const std::int64_t bricks =
        ((brick.z + bias) << brick_axis_bits | (brick.y + bias)) << brick_axis_bits | (brick.x + bias);
    const std::int64_t place = ((p.z - cell.z * cell_units) << place_axis_bits | (p.y - cell.y * cell_units))
                                   << place_axis_bits |
                               (p.x - cell.x * cell_units);
    return {static_cast<std::uint64_t>(bricks << brick_index_bits | index_in_brick(cell)),
            static_cast<std::uint64_t>(place)};
}

MENISCUS_HD inline Int3 key_brick(std::uint64_t cell_key) {
    constexpr std::int64_t mask = (std::int64_t{1} << brick_axis_bits) - 1;
    constexpr std::int32_t bias = 1 << (brick_axis_bits - 1);
    const auto bricks = static_cast<std::int64_t>(cell_key >> brick_index_bits);
    return {static_cast<std::int32_t>(bricks & mask) - bias,
            static_cast<std::int32_t>(bricks >> brick_axis_bits & mask) - bias,
            static_cast<std::int32_t>(bricks >> (2 * brick_axis_bits)) - bias};
}
MENISCUS_HD inline int key_index(std::uint64_t cell_key) {
    return static_cast<int>(cell_key & (brick_volume - 1));
}

/// A support cell's corner, in units.
MENISCUS_HD inline Units3 cell_corner(std::uint64_t cell_key, std::int64_t cell_units) {
    const Int3 brick = key_brick(cell_key);
    const Int3 place = place_in_brick(key_index(cell_key));
    return {(brick.x * brick_size + place.x) * cell_units, (brick.y * brick_size + place.y) * cell_units,
            (brick.z * brick_size + place.z) * cell_units};
}

/// A key's position, in units from the corner of its support cell.
MENISCUS_HD inline Units3 place_in_cell(const ParticleKey& key) {
    constexpr std::uint64_t mask = (std::uint64_t{1} << place_axis_bits) - 1;
    return {static_cast<std::int64_t>(key.place & mask), static_cast<std::int64_t>(key.place >> place_axis_bits & mask),
            static_cast<std::int64_t>(key.place >> (2 * place_axis_bits))};
}

/// The same in the world, in units.
MENISCUS_HD inline Units3 key_place(const ParticleKey& key, std::int64_t cell_units) {
    const Units3 corner = cell_corner(key.cell, cell_units);
    const Units3 place = place_in_cell(key);
    return {corner.x + place.x, corner.y + place.y, corner.z + place.z};
}

/// A key's position, in units from the corner of its support cell's brick.
MENISCUS_HD inline void key_position(const ParticleKey& key, std::int64_t cell_units, float& x, float& y, float& z) {
    const Int3 cell = place_in_brick(key_index(key.cell));
    const Units3 place = place_in_cell(key);
    x = static_cast<float>(cell.x * cell_units + place.x);
    y = static_cast<float>(cell.y * cell_units + place.y);
    z = static_cast<float>(cell.z * cell_units + place.z);
}

}  // namespace meniscus
