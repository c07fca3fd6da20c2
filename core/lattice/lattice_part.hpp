// The part of a frame's lattice that one reconstruction makes: the base cells of its own bricks, and those around them.
#pragma once

#include <cstdint>

#include "lattice/brick_grid.hpp"
#include "lattice/coordinates.hpp"
#include "lattice/host_device.hpp"

namespace meniscus {

/// The base cells from `low` to below `high`.
struct BaseCellBox {
    Int3 low, high;

    MENISCUS_HD bool holds(const Int3& cell) const {
        return cell.x >= low.x && cell.x < high.x && cell.y >= low.y && cell.y < high.y && cell.z >= low.z &&
               cell.z < high.z;
    }
    /// Those of a word of Brick::occupied that lie in the box, as bits. brick: its coordinate.
    MENISCUS_HD std::uint64_t word(const Int3& brick, int w) const {
        const auto clamped = [](std::int32_t cell) { return cell < 0 ? 0 : cell > brick_size ? brick_size : cell; };
        const std::int32_t first = clamped(low.x - brick.x * brick_size);
        const std::int32_t last = clamped(high.x - brick.x * brick_size);
        const std::int32_t z = brick.z * brick_size + (w >> 2);
        if (first >= last || z < low.z || z >= high.z) return 0;
        const std::uint64_t row = (std::uint64_t{1} << last) - (std::uint64_t{1} << first);
        std::uint64_t cells = 0;
        for (int i = 0; i < 4; ++i) {
            const std::int32_t y = brick.y * brick_size + 4 * (w & 3) + i;
            if (y >= low.y && y < high.y) cells |= row << (brick_size * i);
        }
        return cells;
    }
    MENISCUS_HD constexpr bool operator==(const BaseCellBox& o) const { return low == o.low && high == o.high; }
    MENISCUS_HD BaseCellBox widened(std::int32_t cells) const {
        return {{low.x - cells, low.y - cells, low.z - cells}, {high.x + cells, high.y + cells, high.z + cells}};
    }
};

/// A part ends without a wall: signs at its end are the field's, and beyond it no cell is in the band.
/// (core/README.md#parts-that-are-put-together)
struct LatticePart {
    bool is_whole = true;
    BaseCellBox own;       ///< whole bricks: the mesh is that of their cells
    BaseCellBox settling;  ///< cells that may be in the band

    MENISCUS_HD constexpr bool operator==(const LatticePart& o) const {
        return is_whole == o.is_whole && own == o.own && settling == o.settling;
    }
    /// The cells whose blocks are stored: also those that hold the points on the upper faces of the last cells.
    MENISCUS_HD BaseCellBox stored() const {
        return {settling.low, {settling.high.x + 1, settling.high.y + 1, settling.high.z + 1}};
    }
    MENISCUS_HD bool owns(const Int3& cell) const { return is_whole || own.holds(cell); }
    MENISCUS_HD bool owns_brick(const Int3& brick) const {
        return owns({brick.x * brick_size, brick.y * brick_size, brick.z * brick_size});
    }
    MENISCUS_HD bool settles(const Int3& cell) const { return is_whole || settling.holds(cell); }
    MENISCUS_HD std::uint64_t settling_word(const Int3& brick, int w) const {
        return is_whole ? ~std::uint64_t{0} : settling.word(brick, w);
    }
};

}  // namespace meniscus
