// The entropy profile's first sections: cells that draw, their levels, and signs. One body codes and decodes.
//
// What is certain costs next to nothing: all points on the closed box of a cell that draws nothing have one sign.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "codec/lattice/brick_lattice.hpp"
#include "codec/lattice/entropy_tables.hpp"

namespace meniscus {

/// Of each cell of a row the context of its level, without the level of the cell before it, which counts 32. levels: of
/// the row, in an array of the closed brick.
inline std::array<int, brick_size> contexts_of_levels(const std::uint8_t* levels) {
    const std::uint8_t* const north = levels - closed_step(1);
    const std::uint8_t* const below = levels - closed_step(2);
    const std::uint8_t* const below_north = below - closed_step(1);
    const std::uint8_t* const below_south = below + closed_step(1);
    static constexpr std::array<std::uint8_t, 19> edge_classes{0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 5, 6, 6, 6, 7, 7, 7, 7};
    static constexpr std::array<std::uint8_t, 13> corner_classes{0, 1, 1, 2, 2, 2, 3, 3, 3, 3, 3, 3, 3};
    std::array<int, brick_size> contexts;
    for (int x = 0; x < brick_size; ++x) {
        const int across_edges =
            north[x - 1] + north[x + 1] + below[x - 1] + below[x + 1] + below_north[x] + below_south[x];
        const int across_corners = below_north[x - 1] + below_north[x + 1] + below_south[x - 1] + below_south[x + 1];
        contexts[static_cast<std::size_t>(x)] = (north[x] << 2 | below[x] << 4) * 32 +
                                                edge_classes[static_cast<std::size_t>(across_edges)] * 4 +
                                                corner_classes[static_cast<std::size_t>(across_corners)];
    }
    return contexts;
}

/// Likewise of whether it draws, where all cells that do have one level. The cell before it counts 7.
inline std::array<int, brick_size> contexts_of_cells(const std::uint8_t* levels) {
    const auto draws = [](std::uint8_t level) { return level != 0 ? 1 : 0; };
    const std::uint8_t* const north = levels - closed_step(1);
    const std::uint8_t* const below = levels - closed_step(2);
    std::array<int, brick_size> contexts;
    for (int x = 0; x < brick_size; ++x)
        contexts[static_cast<std::size_t>(x)] = (draws(north[x]) * 2 + draws(below[x]) * 4) * 7 + draws(north[x - 1]) +
                                                draws(north[x + 1]) + draws(below[x - 1]) + draws(below[x + 1]) +
                                                draws(below[x - closed_step(1)]) + draws(below[x + closed_step(1)]);
    return contexts;
}

/// Codes which cells draw, and their levels. When it decodes, the lattice is clear before, and has its cells after.
/// one_level: of all cells; 0 if they differ. Returns the finest level that was coded: beyond 3 none is known.
template <class Coder>
int code_cells(Coder& coder, const EntropyTables& tables, BrickLattice& lattice, int one_level) {
    coder.reserve(brick_size * brick_size + brick_volume);
    int finest = one_level;
    std::uint32_t rows_before = 0;  // the slice below, bit y
    const auto level = [&lattice](int place) { return int{lattice.level[place]}; };
    for (int z = 0; z < brick_size; ++z) {
        std::uint32_t rows = 0;
        for (int y = 0; y < brick_size; ++y) {
            const int first = closed_place(0, y, z);
            const auto context = static_cast<int>((y > 0 ? rows >> (y - 1) & 1 : 0) | (rows_before >> y & 1) << 1 |
                                                  (rows_before >> (y + 1) & 1) << 2);
            bool any = false;
            if constexpr (Coder::encodes)
                for (int x = 0; x < brick_size; ++x) any = any || level(first + x) != 0;
            any = coder.code(tables.rows, context, any ? 1 : 0) != 0;
            if (!any) continue;
            rows |= 1U << y;
            const std::array<int, brick_size> contexts =
                one_level != 0 ? contexts_of_cells(&lattice.level[first]) : contexts_of_levels(&lattice.level[first]);
            for (int x = 0; x < brick_size; ++x) {
                const int at = first + x;
                const int west = level(at - 1);
                const int before = contexts[static_cast<std::size_t>(x)];
                int symbol = level(at);
                if (one_level != 0)
                    symbol = coder.code(tables.cells, before + (west != 0 ? 7 : 0), symbol != 0 ? 1 : 0) * one_level;
                else
                    symbol = coder.code(tables.levels, before + west * 32, symbol);
                if constexpr (!Coder::encodes)
                    if (symbol != 0) lattice.add_cell(at, std::min(symbol, 3));
                finest = std::max(finest, symbol);
            }
        }
        rows_before = rows;
    }
    return finest;
}

/// Signs of a brick's corner points, row by row along x.
template <class Coder>
class SignCoder {
public:
    SignCoder(Coder& coder, const EntropyTables& tables) : coder_(coder), tables_(tables) {}

    /// The lattice has its blocks listed. When it decodes, its signs are filled.
    void run(BrickLattice& lattice) {
        lattice_ = &lattice;
        for (const std::uint16_t place : lattice_->blocks())
            if (draws_nothing(place)) undrawn_[place] = undrawn;
        for (const std::uint16_t place : lattice_->blocks()) code_block(place);
        // Places that the next brick does not use must say nothing.
        for (const std::uint16_t place : lattice_->blocks()) {
            undrawn_[place] = 0;
            known_[place] = 0;
            base_[place] = 0;
        }
    }

private:
    enum State : std::uint8_t { outside = 0, unknown = 1, inside = 2 };

    /// Bits of a cell that draws nothing, and of the sign that all of its points have, once one is known.
    static constexpr std::uint8_t all_outside = 1, all_inside = 2, undrawn = 4;
    /// Such a byte of each of the eight cells around a block, the cell down by closed_steps(i) in byte 7 - i.
    using CellsAround = std::uint64_t;
    static constexpr CellsAround one_of_each = 0x0101010101010101;
    static constexpr CellsAround no_step_along_x = 0x0100010001000100;
    static constexpr CellsAround no_step_along_y = 0x0101000001010000;
    static constexpr CellsAround no_step_along_z = 0x0101010100000000;

    /// Whether a cell draws nothing, as all of the brick's cells that have no level.
    bool draws_nothing(int place) const {
        const Int3 at = closed_coordinate(place);
        return lattice_->level[place] == 0 && at.x < brick_size && at.y < brick_size && at.z < brick_size;
    }

    void code_block(int place) {
        const BlockMask points = lattice_->corners[place];
        coder_.reserve(16);
        // The signs as they get known, of the encoder's too: contexts must not look ahead.
        truth_ = lattice_->inside[place];
        now_ = 0;
        known_now_ = 0;
        place_ = place;
        CellsAround around = 0;
        for (int i = 0; i < 8; ++i) around |= CellsAround{undrawn_[place - closed_steps(i)]} << 8 * (7 - i);
        cells_ = around;
        // A row with any points has its first.
        for (BlockMask rows = points & low_face(0); rows != 0; rows &= rows - 1) {
            const int row = lowest_bit(rows);
            code_row(point_coordinate(row, 1), point_coordinate(row, 2), static_cast<unsigned>(points >> row & 15));
        }
        if (cells_ != around)
            for (int i = 0; i < 8; ++i)
                undrawn_[place - closed_steps(i)] = static_cast<std::uint8_t>(cells_ >> 8 * (7 - i));
        lattice_->inside[place] = now_ | (truth_ & ~points);  // an encoder's signs of middles stay
        known_[place] = known_now_;
        base_[place] = static_cast<std::int8_t>((now_ & 1) != 0 ? 1 : -1);
    }

    void code_row(int y, int z, unsigned wanted) {
        const int row = point_bit(0, y, z);
        // Cells that hold the whole row: no step along x; those that hold its first point alone: a step.
        const CellsAround reach = (y == 0 ? one_of_each : no_step_along_y) & (z == 0 ? one_of_each : no_step_along_z);
        const State of_row = sign_of(reach & no_step_along_x);
        unsigned value = static_cast<unsigned>(truth_ >> row) & wanted;
        if (of_row != unknown) {
            const int certain = of_row == inside ? 1 : 0;
            if (wanted == 15)
                value =
                    static_cast<unsigned>(coder_.code(tables_.fours, certain_fours + certain, static_cast<int>(value)));
            else if (wanted == 5)
                value = spread(coder_.code(tables_.twos, certain_twos + certain, join(value)));
            else
                value =
                    static_cast<unsigned>(coder_.code(tables_.ones, certain_ones + certain, static_cast<int>(value)));
        } else {
            const State certain_first = sign_of(reach & ~no_step_along_x);
            if (wanted == 15)
                value = code_four(y, z, certain_first, value);
            else if (wanted == 5)
                value = code_two(y, z, certain_first, value);
            else
                value = code_one(y, z, certain_first, value);
        }
        now_ |= BlockMask{value} << row;
        known_now_ |= BlockMask{wanted} << row;
        const CellsAround without_sign = cells_ / undrawn & ~(cells_ / all_outside | cells_ / all_inside) & reach;
        cells_ |= without_sign * ((value & 1) != 0 ? all_inside : all_outside);
    }
    static int join(unsigned value) { return static_cast<int>((value & 1) | value >> 1); }
    static unsigned spread(int symbol) { return static_cast<unsigned>((symbol & 1) | (symbol & 2) << 1); }

    /// The sign of the points that these cells share: by the first whose sign is known. cells: a bit in the byte of
    /// each.
    State sign_of(CellsAround cells) const {
        const CellsAround known = (cells_ / all_outside | cells_ / all_inside) & cells;
        if (known == 0) return unknown;
        return (cells_ >> highest_bit(known) & all_inside) != 0 ? inside : outside;
    }

    /// Signs and known points of a row up to four points back along y and z, as bits 0 to 3.
    struct Row {
        unsigned signs;
        unsigned known;
    };
    Row row_at(int y, int z) const {
        const int place = place_ - (y < 0 ? closed_step(1) : 0) - (z < 0 ? closed_step(2) : 0);
        const int row = point_bit(0, y & 3, z & 3);
        if (place == place_)
            return {static_cast<unsigned>(now_ >> row & 15), static_cast<unsigned>(known_now_ >> row & 15)};
        return {static_cast<unsigned>(lattice_->inside[place] >> row & known_[place] >> row & 15),
                static_cast<unsigned>(known_[place] >> row & 15)};
    }
    /// The sign of the nearest of these points of a block, which have the highest bits, that is known.
    State nearest_of(int place, BlockMask points) const {
        points &= known_[place];
        if (points == 0) return unknown;
        return (lattice_->inside[place] >> highest_bit(points) & 1) != 0 ? inside : outside;
    }
    /// The last known point of the row in the block before along x, at most this far before the row's first: 1, 2 or 4.
    State west_of(int y, int z, int last) const {
        const BlockMask points = last == 1 ? 8 : last == 2 ? 12 : 13;
        return nearest_of(place_ - closed_step(0), points << point_bit(0, y, z));
    }
    /// The nearest known point 1, 2 or 4 points before one of the block's along y or z, on which that is the
    /// at-th. line: the first of these.
    State nearest_before(int axis, int at, int line) const {
        // Distances that stay in the block, and those that reach the one before.
        static constexpr std::array<std::array<BlockMask, base_cell_size>, 2> own{
            {{0, 0x1, 0x11, 0x110}, {0, 0x1, 0x10001, 0x100010000}}};
        static constexpr std::array<std::array<BlockMask, base_cell_size>, 2> before{
            {{0x1101, 0x1010, 0x100, 0x1000}, {0x1000100000001, 0x1000000010000, 0x100000000, 0x1000000000000}}};
        const auto a = static_cast<std::size_t>(axis - 1);
        const auto i = static_cast<std::size_t>(at);
        const BlockMask here = known_now_ & own[a][i] << line;
        if (here != 0) return (now_ >> highest_bit(here) & 1) != 0 ? inside : outside;
        return nearest_of(place_ - closed_step(axis), before[a][i] << line);
    }

    unsigned code_four(int y, int z, State certain_first, unsigned value) {
        const Row north = row_at(y - 1, z);
        const Row below = row_at(y, z - 1);
        const bool has_north = north.known == 15;
        const bool has_below = below.known == 15;
        const State west = certain_first != unknown ? certain_first : west_of(y, z, 1);
        const unsigned before = west != unknown ? (west == inside ? 1U : 0U)
                                : has_north     ? north.signs & 1
                                : has_below     ? below.signs & 1
                                                : 0;
        unsigned context;
        if (has_north && has_below) {
            const Row corner = row_at(y - 1, z - 1);
            const unsigned middle = corner.known != 15        ? 1
                                    : (corner.signs & 6) == 0 ? 0
                                    : (corner.signs & 6) == 6 ? 2
                                                              : 1;
            context = (north.signs | below.signs << 4 | before << 8) * 3 + middle;
        } else if (has_north) {
            context = EntropyTables::fours_of_both + (north.signs | before << 4);
        } else if (has_below) {
            context = EntropyTables::fours_of_both + EntropyTables::fours_of_one + (below.signs | before << 4);
        } else {
            context = EntropyTables::fours_of_both + 2 * EntropyTables::fours_of_one + before;
        }
        return static_cast<unsigned>(coder_.code(tables_.fours, static_cast<int>(context), static_cast<int>(value)));
    }

    unsigned code_two(int y, int z, State certain_first, unsigned value) {
        const Row north = row_at(y - 2, z);
        const Row below = row_at(y, z - 2);
        const unsigned has_north = (north.known & 5) == 5 ? 1 : 0;
        const unsigned has_below = (below.known & 5) == 5 ? 1 : 0;
        const auto n = has_north != 0 ? static_cast<unsigned>(join(north.signs & 5)) : 0U;
        const auto b = has_below != 0 ? static_cast<unsigned>(join(below.signs & 5)) : 0U;
        const State west = certain_first != unknown ? certain_first : west_of(y, z, 2);
        const unsigned before = west != unknown ? (west == inside ? 1U : 0U) : has_north != 0 ? n & 1 : b & 1;
        const Row corner = row_at(y - 2, z - 2);
        const unsigned middle = (corner.known & 5) != 5   ? 1
                                : (corner.signs & 5) == 0 ? 0
                                : (corner.signs & 5) == 5 ? 2
                                                          : 1;
        const unsigned context = ((n | b << 2 | before << 4 | has_north << 5 | has_below << 6) * 3) + middle;
        return spread(coder_.code(tables_.twos, static_cast<int>(context), join(value)));
    }

    /// Of the base lattice's point that many blocks away: 1 inside, -1 outside, 0 unknown.
    int base_point(int dx, int dy, int dz) const {
        return base_[place_ + dx + dy * closed_step(1) + dz * closed_step(2)];
    }

    unsigned code_one(int y, int z, State certain_first, unsigned value) {
        if (certain_first != unknown)
            return static_cast<unsigned>(
                coder_.code(tables_.ones, certain_ones + (certain_first == inside ? 1 : 0), static_cast<int>(value)));
        const int neighbors = west_of(y, z, 4) + 3 * nearest_before(1, y, point_bit(0, 0, z)) +
                              9 * nearest_before(2, z, point_bit(0, y, 0));
        if (y != 0 || z != 0) {
            const unsigned shown = kind_of_face(y, z);
            return static_cast<unsigned>(
                coder_.code(tables_.ones, EntropyTables::ones_of_corners + neighbors * 3 + static_cast<int>(shown),
                            static_cast<int>(value)));
        }
        const int of_cell =
            base_point(-1, -1, 0) + base_point(-1, 0, -1) + base_point(0, -1, -1) + base_point(-1, -1, -1);
        int sum = of_cell + base_point(1, -1, 0) + base_point(1, 0, -1) + base_point(0, 1, -1) + base_point(-1, 1, -1) +
                  base_point(1, -1, -1);
        sum = sum < -2 ? 0 : sum < 0 ? 1 : sum == 0 ? 2 : sum < 3 ? 3 : 4;
        // A level-1 cell sees both signs at its corners: its last is unlike the others if those are alike.
        int alike = 0;
        if (lattice_->level[place_ - closed_steps(7)] == 1) {
            const int seven = of_cell + base_point(-1, 0, 0) + base_point(0, -1, 0) + base_point(0, 0, -1);
            alike = seven == -7 ? 1 : seven == 7 ? 2 : 0;
        }
        return static_cast<unsigned>(
            coder_.code(tables_.ones, (neighbors * 5 + sum) * 3 + alike, static_cast<int>(value)));
    }
    /// Which of the block's faces a point at x = 0 lies on beside that.
    static unsigned kind_of_face(int y, int z) { return y == 0 ? 0 : z == 0 ? 1 : 2; }

    static constexpr int certain_fours = EntropyTables::fours_known;
    static constexpr int certain_twos = EntropyTables::twos_known;
    static constexpr int certain_ones = EntropyTables::ones_of_corners + EntropyTables::ones_of_faces;

    Coder& coder_;
    const EntropyTables& tables_;
    BrickLattice* lattice_ = nullptr;
    ClosedArray<BlockMask> known_;       ///< points coded so far
    ClosedArray<std::int8_t> base_;      ///< of blocks coded so far, the sign of the first point: 1 inside, -1 outside
    ClosedArray<std::uint8_t> undrawn_;  ///< of cells that draw nothing
    int place_ = 0;                      ///< of the block that is being coded
    BlockMask truth_ = 0, now_ = 0, known_now_ = 0;
    CellsAround cells_ = 0;
};

/// Whether beyond the brick's own faces lie coarser cells; needs all signs.
template <class Coder>
void code_coarser_faces(Coder& coder, const EntropyTables& tables, BrickLattice& lattice) {
    coder.reserve(6 * lattice.cells().size());
    lattice.for_each_outer_face([&](int place, int bit) {
        const int symbol =
            coder.code(tables.coarser, (lattice.level[place] - 2) * 2 + (bit & 1), lattice.coarser[place] >> bit & 1);
        lattice.coarser[place] = static_cast<std::uint8_t>((lattice.coarser[place] & ~(1 << bit)) | symbol << bit);
    });
}

}  // namespace meniscus
