// A subset of a grid's members as bits: 64 cells of a brick are decided at once.
#pragma once

#include <cstdint>

#include "lattice/brick_grid.hpp"
#include "lattice/host_device.hpp"

namespace meniscus {

/// One word for each word of Brick::occupied, brick after brick.
struct CellSetView {
    BrickGridView grid;
    std::uint64_t* words = nullptr;

    MENISCUS_HD std::uint64_t& word(std::uint32_t brick, int w) const {
        return words[static_cast<std::size_t>(brick) * Brick::words + static_cast<std::size_t>(w)];
    }

    /// place: index_in_brick.
    MENISCUS_HD void put(std::uint32_t brick, int place, bool member) const {
        std::uint64_t& cells = word(brick, place >> 6);
        cells = (cells & ~(std::uint64_t{1} << (place & 63))) | std::uint64_t{member} << (place & 63);
    }

    /// For the 64 cells of a word, whether the cells at an offset of -1, 0 or 1 a side from them are in the set.
    MENISCUS_HD std::uint64_t moved(std::uint32_t brick, int w, const Int3& offset) const {
        const std::uint64_t own = moved_in_slice(brick, w, 0, offset.y, offset.z);
        if (offset.x == 0) return own;
        const std::uint64_t beyond = moved_in_slice(brick, w, offset.x, offset.y, offset.z);
        return offset.x > 0 ? (own >> 1 & ~last_of_rows) | (beyond << 15 & last_of_rows)
                            : (own << 1 & ~first_of_rows) | (beyond >> 15 & first_of_rows);
    }

private:
    /// The same without the move along x: in the brick itself, or in the next one along x.
    MENISCUS_HD std::uint64_t moved_in_slice(std::uint32_t brick, int w, int brick_x, int y, int z) const {
        const std::uint64_t own = word_or_none(brick, brick_x, w & 3, (w >> 2) + z);
        if (y == 0) return own;
        const std::uint64_t beyond = word_or_none(brick, brick_x, (w & 3) + y, (w >> 2) + z);
        return y > 0 ? own >> 16 | beyond << 48 : own << 16 | beyond >> 48;
    }
    /// y: in rows of four cells, -1 to 4. z: -1 to 16.
    MENISCUS_HD std::uint64_t word_or_none(std::uint32_t brick, int brick_x, int y, int z) const {
        const int there = neighbor_slot(brick_x, y >> 2, z >> brick_axis_shift);
        if (there != own_slot) {
            brick = grid.neighbors[brick].brick[there];
            if (brick == no_index) return 0;
        }
        return word(brick, (y & 3) | (z & brick_axis_mask) << 2);
    }
};

}  // namespace meniscus
