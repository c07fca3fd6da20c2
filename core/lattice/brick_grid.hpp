// A sparse set of integer coordinates, kept as bricks of 16 x 16 x 16 bits, and their numbering.
//
// Members are numbered brick by brick (z, y, x), and by (z, y, x) inside a brick, by counting bits: no hash, no search
// inside a brick. Base cells that may hold surface are stored in one such grid, particles in others.
#pragma once

#include <cstdint>

#include "lattice/bits.hpp"
#include "lattice/coordinates.hpp"
#include "lattice/host_device.hpp"
#include "meniscus/memory.hpp"

namespace meniscus {

inline constexpr int brick_size = 16;  ///< members a side
inline constexpr int brick_volume = brick_size * brick_size * brick_size;
inline constexpr int brick_axis_shift = 4;  ///< log2 of brick_size
inline constexpr int brick_index_bits = 3 * brick_axis_shift;
inline constexpr int brick_axis_mask = brick_size - 1;
inline constexpr std::uint32_t no_index = 0xFFFFFFFFU;
static_assert(brick_size == 1 << brick_axis_shift);
// A brick of base cells is the unit of encoding and streaming, too: meshes are ordered by the one and cut by the other.
static_assert(brick_size == brick_base_cells);

MENISCUS_HD constexpr Int3 brick_of(const Int3& c) {
    return {c.x >> brick_axis_shift, c.y >> brick_axis_shift, c.z >> brick_axis_shift};
}
/// Index inside a brick: x + 16 y + 256 z.
MENISCUS_HD constexpr int index_in_brick(const Int3& c) {
    return (c.x & brick_axis_mask) | (c.y & brick_axis_mask) << brick_axis_shift |
           (c.z & brick_axis_mask) << (2 * brick_axis_shift);
}
/// The place in a brick that has this index, from the brick's corner.
MENISCUS_HD constexpr Int3 place_in_brick(int index) {
    return {index & brick_axis_mask, index >> brick_axis_shift & brick_axis_mask, index >> (2 * brick_axis_shift)};
}

/// The members of a word of Brick::occupied that lie at x = 0, one in each of its four rows.
inline constexpr std::uint64_t first_of_rows = 0x0001000100010001ULL;
/// The members at x = 15.
inline constexpr std::uint64_t last_of_rows = first_of_rows << (brick_size - 1);

/// Orders bricks by (z, y, x); 20 bits a side hold every brick of either grid.
MENISCUS_HD constexpr std::uint64_t brick_key(const Int3& b) {
    constexpr std::int64_t bias = 1 << 19;
    return static_cast<std::uint64_t>((b.z + bias) << 40 | (b.y + bias) << 20 | (b.x + bias));
}

MENISCUS_HD inline Int3 brick_coordinate(std::uint64_t brick_key) {
    constexpr std::uint64_t mask = (1U << 20) - 1;
    constexpr std::int32_t bias = 1 << 19;
    return {static_cast<std::int32_t>(brick_key & mask) - bias,
            static_cast<std::int32_t>(brick_key >> 20 & mask) - bias,
            static_cast<std::int32_t>(brick_key >> 40) - bias};
}

struct Brick {
    static constexpr int words = brick_volume / 64;
    Int3 coordinate;
    std::uint32_t first = 0;        ///< number of its first member
    std::uint64_t occupied[words];  ///< word w: the rows y = 4 (w % 4) ... + 3 of the slice z = w / 4
    std::uint16_t rank[words];      ///< number of members in the words before

    /// The brick's lowest place.
    MENISCUS_HD Int3 corner() const {
        return {coordinate.x * brick_size, coordinate.y * brick_size, coordinate.z * brick_size};
    }
    MENISCUS_HD bool holds(int index) const { return (occupied[index >> 6] >> (index & 63) & 1) != 0; }
    /// Number of the member at `index`, or of the next one after it.
    MENISCUS_HD std::uint32_t number(int index) const {
        const std::uint64_t before = (std::uint64_t{1} << (index & 63)) - 1;
        return first + rank[index >> 6] + static_cast<std::uint32_t>(popcount(occupied[index >> 6] & before));
    }
    /// Counts the words; returns the number of members.
    MENISCUS_HD std::uint32_t count() {
        std::uint32_t total = 0;
        for (int w = 0; w < words; ++w) {
            rank[w] = static_cast<std::uint16_t>(total);
            total += static_cast<std::uint32_t>(popcount(occupied[w]));
        }
        return total;
    }
    MENISCUS_HD void clear() {
        for (std::uint64_t& word : occupied) word = 0;
    }
    /// Calls visit(first number, count) for every run of members in a row along x of the box [low, high] inside the
    /// brick, in ascending order of their numbers.
    template <class Visit>
    MENISCUS_HD void for_each_run(const Int3& low, const Int3& high, Visit&& visit) const {
        const std::uint64_t span = (std::uint64_t{2} << high.x) - (std::uint64_t{1} << low.x);
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y) {
                const int row = y << 4 | z << 8;
                const std::uint64_t members = occupied[row >> 6] >> (row & 63) & span;
                if (members != 0) visit(number(row | low.x), static_cast<std::uint32_t>(popcount(members)));
            }
    }
};

/// Slot of the brick at an offset of -1, 0 or 1 a side among the 27 around one.
MENISCUS_HD constexpr int neighbor_slot(int dx, int dy, int dz) {
    return 13 + dx + 3 * dy + 9 * dz;
}
/// The offset of a slot.
MENISCUS_HD constexpr Int3 neighbor_offset(int slot) {
    return {slot % 3 - 1, slot / 3 % 3 - 1, slot / 9 - 1};
}
inline constexpr int neighbor_slots = 27;
inline constexpr int own_slot = neighbor_slot(0, 0, 0);

/// The 27 bricks around one, itself in the middle; no_index where there is none.
struct BrickNeighbors {
    std::uint32_t brick[neighbor_slots];
};

/// Any values will do: they cost time where wrong, and nothing else.
struct BrickHints {
    std::uint32_t row[4] = {};  ///< indices by the parities of a row's y and z
    MENISCUS_HD std::uint32_t& of_row(int y, int z) { return row[(y & 1) | (z & 1) << 1]; }
};

/// No hints, where remembering costs more than searching: a GPU's thread would keep them in memory.
struct NoBrickHints {
    std::uint32_t none = no_index;
    MENISCUS_HD std::uint32_t& of_row(int, int) { return none = no_index; }
};

struct BrickGridView {
    const Brick* bricks = nullptr;
    const std::uint64_t* keys = nullptr;        ///< brick_key of each, ascending
    const BrickNeighbors* neighbors = nullptr;  ///< present only where neighbor() is used
    std::uint32_t brick_count = 0;

    /// Index of the first brick whose key is not below this one. Found at once if it is `hint`.
    MENISCUS_HD std::uint32_t lower_bound(std::uint64_t key, std::uint32_t hint) const {
        if (hint < brick_count && keys[hint] >= key && (hint == 0 || keys[hint - 1] < key)) return hint;
        std::uint32_t low = 0;
        std::uint32_t high = brick_count;
        while (low < high) {
            const std::uint32_t middle = low + (high - low) / 2;
            if (keys[middle] < key)
                low = middle + 1;
            else
                high = middle;
        }
        return low;
    }
    /// Index of a brick, or no_index.
    MENISCUS_HD std::uint32_t find(const Int3& brick) const {
        const std::uint64_t key = brick_key(brick);
        const std::uint32_t at = lower_bound(key, no_index);
        return at < brick_count && keys[at] == key ? at : no_index;
    }

    /// Number of the member at an offset from one in this brick, no farther than the bricks around; no_index if there
    /// is none.
    MENISCUS_HD std::uint32_t neighbor(std::uint32_t brick, int index, const Int3& offset) const {
        const Int3 to = place_in_brick(index) + offset;
        if (((to.x | to.y | to.z) & ~brick_axis_mask) != 0) {
            const Int3 beyond = brick_of(to);
            brick = neighbors[brick].brick[neighbor_slot(beyond.x, beyond.y, beyond.z)];
            if (brick == no_index) return no_index;
        }
        const int there = index_in_brick(to);
        return bricks[brick].holds(there) ? bricks[brick].number(there) : no_index;
    }

    /// The numbers of the members at `offset` (x = 0) and one further along x.
    struct Pair {
        std::uint32_t first, second;
    };
    MENISCUS_HD Pair neighbor_pair(std::uint32_t brick, int index, const Int3& offset) const {
        // In a row, members are numbered one after the other.
        if ((index & brick_axis_mask) == brick_size - 1)
            return {neighbor(brick, index, offset), neighbor(brick, index, {1, offset.y, offset.z})};
        const Int3 to = place_in_brick(index) + Int3{0, offset.y, offset.z};
        if (((to.y | to.z) & ~brick_axis_mask) != 0) {
            const Int3 beyond = brick_of(to);
            brick = neighbors[brick].brick[neighbor_slot(0, beyond.y, beyond.z)];
            if (brick == no_index) return {no_index, no_index};
        }
        const int there = index_in_brick(to);
        const std::uint64_t members = bricks[brick].occupied[there >> 6] >> (there & 63);
        const std::uint32_t number = bricks[brick].number(there);
        const bool first = (members & 1) != 0;
        return {first ? number : no_index, (members & 2) != 0 ? number + static_cast<std::uint32_t>(first) : no_index};
    }

    /// Calls visit(brick, low, high) for every brick that the box [low, high] meets, in ascending order, with the part
    /// of the box inside it. `hints` are where the last call found its rows of bricks; one that has not gone far
    /// finds them there again.
    template <class Hints, class Visit>
    MENISCUS_HD void for_each_brick(const Int3& low, const Int3& high, Hints& hints, Visit&& visit) const {
        const Int3 brick_low = brick_of(low);
        const Int3 brick_high = brick_of(high);
        constexpr int end = brick_size - 1;
        for (std::int32_t z = brick_low.z; z <= brick_high.z; ++z)
            for (std::int32_t y = brick_low.y; y <= brick_high.y; ++y) {
                const std::uint64_t last = brick_key({brick_high.x, y, z});
                std::uint32_t& hint = hints.of_row(y, z);
                hint = lower_bound(brick_key({brick_low.x, y, z}), hint);
                for (std::uint32_t i = hint; i < brick_count && keys[i] <= last; ++i) {
                    const std::int32_t x = bricks[i].coordinate.x;
                    visit(bricks[i],
                          Int3{x == brick_low.x ? low.x & end : 0, y == brick_low.y ? low.y & end : 0,
                               z == brick_low.z ? low.z & end : 0},
                          Int3{x == brick_high.x ? high.x & end : end, y == brick_high.y ? high.y & end : end,
                               z == brick_high.z ? high.z & end : end});
                }
            }
    }
};

/// Owner of a grid's arrays.
struct BrickGrid {
    explicit BrickGrid(const std::shared_ptr<MemoryAccount>& account)
        : bricks(AccountAllocator<Brick>(account)),
          keys(AccountAllocator<std::uint64_t>(account)),
          neighbors(AccountAllocator<BrickNeighbors>(account)) {}

    Array<Brick> bricks;
    Array<std::uint64_t> keys;
    Array<BrickNeighbors> neighbors;
    std::uint32_t members = 0;

    BrickGridView view() const {
        return {bricks.data(), keys.data(), neighbors.empty() ? nullptr : neighbors.data(),
                static_cast<std::uint32_t>(bricks.size())};
    }
};

}  // namespace meniscus
