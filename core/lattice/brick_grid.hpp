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
inline constexpr std::uint32_t no_index = 0xFFFFFFFFU;

MENISCUS_HD constexpr Int3 brick_of(const Int3& c) {
    return {c.x >> 4, c.y >> 4, c.z >> 4};
}
/// Index inside a brick: x + 16 y + 256 z.
MENISCUS_HD constexpr int index_in_brick(const Int3& c) {
    return (c.x & 15) | (c.y & 15) << 4 | (c.z & 15) << 8;
}

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
    std::uint16_t rank[words];      ///< members in the words before

    /// Its lowest place.
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

/// The 27 bricks around one, itself in the middle; no_index where there is none.
struct BrickNeighbors {
    std::uint32_t brick[27];
};

/// Any values will do: they cost time where wrong, and nothing else.
struct BrickGuesses {
    std::uint32_t row[4] = {};  ///< by the parities of a row's y and z
    MENISCUS_HD std::uint32_t& of_row(int y, int z) { return row[(y & 1) | (z & 1) << 1]; }
};

/// Where remembering costs more than searching: a GPU's thread would keep them in memory.
struct NoBrickGuesses {
    std::uint32_t none = no_index;
    MENISCUS_HD std::uint32_t& of_row(int, int) { return none = no_index; }
};

struct BrickGridView {
    const Brick* bricks = nullptr;
    const std::uint64_t* keys = nullptr;        ///< brick_key of each, ascending
    const BrickNeighbors* neighbors = nullptr;  ///< present only where neighbor() is used
    std::uint32_t brick_count = 0;

    /// Index of the first brick whose key is not below this one. Right at once if it is `guess`.
    MENISCUS_HD std::uint32_t lower_bound(std::uint64_t key, std::uint32_t guess) const {
        if (guess < brick_count && keys[guess] >= key && (guess == 0 || keys[guess - 1] < key)) return guess;
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
        const int x = (index & 15) + offset.x;
        const int y = (index >> 4 & 15) + offset.y;
        const int z = (index >> 8) + offset.z;
        if (((x | y | z) & ~15) != 0) {
            brick = neighbors[brick].brick[13 + (x >> 4) + 3 * (y >> 4) + 9 * (z >> 4)];
            if (brick == no_index) return no_index;
        }
        const int there = (x & 15) | (y & 15) << 4 | (z & 15) << 8;
        return bricks[brick].holds(there) ? bricks[brick].number(there) : no_index;
    }

    /// The numbers of the members at `offset` (x = 0) and one further along x.
    struct Pair {
        std::uint32_t first, second;
    };
    MENISCUS_HD Pair neighbor_pair(std::uint32_t brick, int index, const Int3& offset) const {
        // In a row, members are numbered one after the other.
        if ((index & 15) == brick_size - 1)
            return {neighbor(brick, index, offset), neighbor(brick, index, {1, offset.y, offset.z})};
        const int y = (index >> 4 & 15) + offset.y;
        const int z = (index >> 8) + offset.z;
        if (((y | z) & ~15) != 0) {
            brick = neighbors[brick].brick[13 + 3 * (y >> 4) + 9 * (z >> 4)];
            if (brick == no_index) return {no_index, no_index};
        }
        const int there = (index & 15) | (y & 15) << 4 | (z & 15) << 8;
        const std::uint64_t members = bricks[brick].occupied[there >> 6] >> (there & 63);
        const std::uint32_t number = bricks[brick].number(there);
        const bool first = (members & 1) != 0;
        return {first ? number : no_index, (members & 2) != 0 ? number + static_cast<std::uint32_t>(first) : no_index};
    }

    /// Calls visit(brick, low, high) for every brick that the box [low, high] meets, in ascending order, with the part
    /// of the box inside it. `guesses` are where the last call found its rows of bricks; one that has not gone far
    /// finds them there again.
    template <class Guesses, class Visit>
    MENISCUS_HD void for_each_brick(const Int3& low, const Int3& high, Guesses& guesses, Visit&& visit) const {
        const Int3 brick_low = brick_of(low);
        const Int3 brick_high = brick_of(high);
        constexpr int end = brick_size - 1;
        for (std::int32_t z = brick_low.z; z <= brick_high.z; ++z)
            for (std::int32_t y = brick_low.y; y <= brick_high.y; ++y) {
                const std::uint64_t last = brick_key({brick_high.x, y, z});
                std::uint32_t& guess = guesses.of_row(y, z);
                guess = lower_bound(brick_key({brick_low.x, y, z}), guess);
                for (std::uint32_t i = guess; i < brick_count && keys[i] <= last; ++i) {
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
