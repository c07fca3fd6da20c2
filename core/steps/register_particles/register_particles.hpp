// Step 1: particles are snapped to the lattice, sorted, and registered in the base cells that they lie in and reach.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "field/lanes.hpp"
#include "field/lattice_settings.hpp"
#include "lattice/brick_grid.hpp"
#include "lattice/coordinates.hpp"
#include "lattice/host_device.hpp"
#include "meniscus/error.hpp"
#include "meniscus/particle_frame.hpp"
#include "particles/particle_set.hpp"

namespace meniscus {

/// The positions of a frame, in one of the two encodings of ParticleFrame.
struct PositionsView {
    const float* positions = nullptr;
    const std::uint16_t* quantized = nullptr;
    double low[3] = {}, high[3] = {};  ///< of the quantization box
    double units_per_length = 0.0;

    MENISCUS_HD Units3 snapped(std::size_t i) const {
        std::int64_t p[3];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double x = quantized != nullptr ? low[axis] + static_cast<double>(quantized[3 * i + axis]) *
                                                                    (high[axis] - low[axis]) / 65535.0
                                                  : static_cast<double>(positions[3 * i + axis]);
            p[axis] = snap(x, units_per_length);
        }
        return {p[0], p[1], p[2]};
    }
};

/// Of a valid frame.
inline PositionsView positions_view(const ParticleFrame& frame, double units_per_length) {
    PositionsView view;
    if (frame.is_quantized())
        view.quantized = frame.quantized.data();
    else
        view.positions = frame.positions.data();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        view.low[axis] = frame.quantization_box.min[axis];
        view.high[axis] = frame.quantization_box.max[axis];
    }
    view.units_per_length = units_per_length;
    return view;
}

/// Where a particle stands in the one order in which the field is summed: by brick of support cells, by support cell,
/// by position. Two particles with the same key are the same.
struct ParticleKey {
    std::uint64_t cell;   ///< brick (z, y, x), then index_in_brick
    std::uint64_t place;  ///< units from the cell's corner: z, y, x, 21 bits each

    MENISCUS_HD bool operator<(const ParticleKey& o) const { return cell != o.cell ? cell < o.cell : place < o.place; }
};

/// How many particles may share a support cell, in the mean over the particles. Water has 8; summing the field takes so
/// much longer that a frame in the wrong unit, or with all its particles in one place, would take hours.
inline constexpr double most_crowded = 1024.0;

/// In the same mean, for frames of any size. crowd: the sum of the squares of the cells' numbers of particles.
MENISCUS_HD inline bool is_crowded(std::uint64_t crowd, std::uint64_t particles, const LatticeSettings& settings) {
    constexpr std::uint64_t small = 16384;
    // Support cells are as large as base cells where those are larger than the support.
    const double cell = static_cast<double>(units_per_base_cell) / static_cast<double>(settings.support[0]);
    const double room = cell > 1.0 ? cell * cell * cell : 1.0;
    return static_cast<double>(crowd) >
           most_crowded * room * static_cast<double>(particles < small ? small : particles);
}

/// Throws LimitExceeded for a frame that is_crowded().
inline void require_uncrowded(std::uint64_t crowd, std::uint64_t particles, const LatticeSettings& settings) {
    if (!is_crowded(crowd, particles, settings)) return;
    throw LimitExceeded("a particle shares its surroundings of one kernel support with " +
                        std::to_string(crowd / particles) +
                        " others in the mean, far more than the field can be summed over (about " +
                        std::to_string(static_cast<int>(most_crowded)) +
                        "): are the positions in the unit of the particle radius, and not all in one place?");
}

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

/// The bricks of base cells that particles in a support cell may reach: all from `low` to `high`.
struct ReachedBricks {
    Int3 low, high;
    MENISCUS_HD bool operator==(const ReachedBricks& o) const { return low == o.low && high == o.high; }
    MENISCUS_HD std::uint32_t count() const {
        return static_cast<std::uint32_t>(high.x - low.x + 1) * static_cast<std::uint32_t>(high.y - low.y + 1) *
               static_cast<std::uint32_t>(high.z - low.z + 1);
    }
};

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

/// A key's position, in units from the corner of its support cell's brick.
MENISCUS_HD inline void key_position(const ParticleKey& key, std::int64_t cell_units, float& x, float& y, float& z) {
    constexpr std::uint64_t mask = (std::uint64_t{1} << place_axis_bits) - 1;
    const Int3 cell = place_in_brick(key_index(key.cell));
    const auto coordinate = [&](int in_brick, std::uint64_t in_cell) {
        return static_cast<float>(in_brick * cell_units + static_cast<std::int64_t>(in_cell & mask));
    };
    x = coordinate(cell.x, key.place);
    y = coordinate(cell.y, key.place >> place_axis_bits);
    z = coordinate(cell.z, key.place >> (2 * place_axis_bits));
}

/// Marks in a brick that one thread alone works on.
struct BrickMarks {
    Brick& brick;
    MENISCUS_HD std::uint64_t word(int w) const { return brick.occupied[w]; }
    MENISCUS_HD void add(int w, std::uint64_t cells) const { brick.occupied[w] |= cells; }
};

/// Marks the base cells of a brick whose closed box lies within a particle's support. Position and support in units,
/// relative to the brick's corner; rounded outward by some units. marks: word(w) reads a word of Brick::occupied,
/// add(w, cells) adds to it.
template <class Marks>
MENISCUS_HD inline void mark_reached(const Marks& marks, float x, float y, float z, float support) {
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
    if (z + reach < 0.0F || y + reach < 0.0F || x + reach < 0.0F) return;
    const int z0 = first(z - reach - 1.0F);
    const int z1 = last(z + reach);
    const int y0 = first(y - reach - 1.0F);
    const int y1 = last(y + reach);
    const int x_low = first(x - (reach + 16.0F));
    const int x_high = last(x + (reach + 16.0F));
    if (x_low > x_high) return;
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
