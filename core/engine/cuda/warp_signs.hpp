// The signs of a few closed cells in a warp's shared memory, and the cases of their subcells, two in every lane.
//
// A closed cell's eight blocks are sixteen half words of 32 points each: a GPU's registers have 32 bits. A row is the
// five points along x at one y and z, coordinates 0 to 4.
#pragma once

#include <cstdint>

#include "engine/cuda/warp.hpp"
#include "lattice/blocks.hpp"
#include "lattice/tables/tables.hpp"

namespace meniscus::cuda {

inline constexpr unsigned closed_cells_a_warp = warp_threads / 8;  ///< each lane looks up one block
inline constexpr unsigned closed_half_words = 16;  ///< block dx + 2 dy + 4 dz has numbers 2 block and 2 block + 1
inline constexpr int points_a_side = base_cell_size + 1;

/// The bits of a closed cell's points, by their places x + 5 y + 25 z. For a block of threads.
struct ClosedPoints {
    static constexpr int count = points_a_side * points_a_side * points_a_side;

    struct alignas(8) Point {
        std::uint32_t below;  ///< the bits below the point's own in its half word
        std::uint32_t half;   ///< the number of that half word
    };
    Point point[count];

    MENISCUS_HD static constexpr unsigned place(unsigned x, unsigned y, unsigned z) {
        return x + points_a_side * (y + points_a_side * z);
    }
    /// The distance of the places of two points one apart along an axis.
    MENISCUS_HD static constexpr unsigned step(unsigned axis) {
        return axis == 0 ? place(1, 0, 0) : axis == 1 ? place(0, 1, 0) : place(0, 0, 1);
    }
    /// All threads of a block must call this, and wait for each other before any reads.
    __device__ void fill() {
        static_assert(block_threads >= count);
        const int i = static_cast<int>(threadIdx.x);
        if (i >= count) return;
        const int x = i % points_a_side;
        const int y = i / points_a_side % points_a_side;
        const int z = i / (points_a_side * points_a_side);
        const int bit = ClosedCell::bit(x, y, z);
        const int block = x >> 2 | (y >> 2) << 1 | (z >> 2) << 2;
        point[i] = {(1U << (bit & 31)) - 1, static_cast<std::uint32_t>(2 * block + (bit >> 5))};
    }
};

/// The cells of a list that a warp works on, each known to eight lanes.
struct CellsOfLanes {
    bool exists;          ///< whether there is a cell for this lane
    std::uint32_t block;  ///< its number, meaningful if it exists
    int level;            ///< 3 where there is none
    std::uint32_t own;    ///< number `lane % 8` of its closed cell's blocks, or no_index

    /// The cells from the `first`-th on of a list of n.
    __device__ CellsOfLanes(const BlocksView& blocks, const std::uint32_t* list, std::uint32_t n, std::uint32_t first)
        : exists(first + lane_index() / 8 < n),
          block(exists ? list[first + lane_index() / 8] : 0),
          level(exists ? blocks.level[block] : 3),
          own(no_index) {
        const int i = static_cast<int>(lane_index() & 7);
        if (exists) own = blocks.neighbor(block, {i & 1, i >> 1 & 1, i >> 2});
    }
};

/// The subcells 2 lane and 2 lane + 1 of a cell, neighbors along x.
struct SubcellPair {
    std::uint32_t cube_case[2];  ///< 0 where there is no subcell: beyond the first, none has a stride above 1

    /// Coordinates and place of the first subcell's lower corner.
    __device__ static unsigned x() { return 2 * (lane_index() & 1); }
    __device__ static unsigned y() { return lane_index() >> 1 & 3; }
    __device__ static unsigned z() { return lane_index() >> 3; }
    __device__ static unsigned place() { return ClosedPoints::place(x(), y(), z()); }
};

struct WarpSigns {
    std::uint32_t inside[closed_cells_a_warp][closed_half_words];
    std::uint32_t stride_shift[closed_cells_a_warp];  ///< log2 of the stride of a cell's subcells

    /// The lanes must wait for each other before any reads.
    __device__ void put(const BlocksView& blocks, const CellsOfLanes& cells) {
        const BlockMask mask = blocks.inside_or_none(cells.own);
        std::uint32_t* const halves = &inside[lane_index() / 8][2 * (lane_index() % 8)];
        halves[0] = static_cast<std::uint32_t>(mask);
        halves[1] = static_cast<std::uint32_t>(mask >> 32);
        if (lane_index() % 8 == 0) stride_shift[lane_index() / 8] = static_cast<std::uint32_t>(3 - cells.level);
    }
    __device__ SubcellPair subcells_of_lane(unsigned cell) const {
        const unsigned stride = 1U << stride_shift[cell];
        const std::uint32_t own = row_of_lane(cell);
        const std::uint32_t up_y = own | __shfl_sync(all_lanes, own, static_cast<int>(lane_index() + stride)) << 8;
        const unsigned row = SubcellPair::y() + points_a_side * SubcellPair::z();
        const std::uint32_t low = __shfl_sync(all_lanes, up_y, static_cast<int>(row));
        const std::uint32_t high = __shfl_sync(all_lanes, up_y, static_cast<int>(row + points_a_side * stride));
        const std::uint32_t rows = (low | high << 16) >> SubcellPair::x();
        const bool has_first = (stride_points(static_cast<int>(stride)) >> (2 * lane_index()) & 1) != 0;
        return {{has_first ? cube_case(rows, stride) : 0, stride == 1 ? cube_case(rows >> 1, 1) : 0}};
    }
    __device__ bool is_inside(const ClosedPoints& points, unsigned cell, unsigned place) const {
        const ClosedPoints::Point point = points.point[place];
        return (inside[cell][point.half] & (point.below + 1)) != 0;
    }

private:
    /// Row y + 5 z = lane of a cell, x as bits; lanes from 25 on repeat the last one.
    __device__ std::uint32_t row_of_lane(unsigned cell) const {
        const int row = static_cast<int>(lane_index() < 25 ? lane_index() : 24);
        const int y = row % points_a_side;
        const int z = row / points_a_side;
        const int half = 2 * ((y >> 2) << 1 | (z >> 2) << 2) + (z >> 1 & 1);
        const int shift = point_bit(0, y & 3, z & 1);
        return (inside[cell][half] >> shift & 15) | (inside[cell][half + 2] >> shift & 1) << 4;
    }
    /// The case of a subcell from x = 0 on. rows: bytes, those at (y, z), one stride up y, one up z, one up both.
    __device__ static std::uint32_t cube_case(std::uint32_t rows, unsigned stride) {
        constexpr std::uint32_t lowest = 0x01010101;
        const std::uint32_t corners = (rows & lowest) | (rows >> stride & lowest) << 1;
        // The product's highest byte takes in two bits of each byte, and nothing carries.
        return corners * 0x01041040U >> 24;
    }
};

}  // namespace meniscus::cuda
