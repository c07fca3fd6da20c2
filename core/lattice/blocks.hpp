// The data of every stored base cell (block), and the way of a cell to the blocks around it.
#pragma once

#include <cstdint>

#include "lattice/bits.hpp"
#include "lattice/block_mask.hpp"
#include "lattice/brick_grid.hpp"
#include "lattice/coordinates.hpp"
#include "lattice/host_device.hpp"

namespace meniscus {

/// Finest lattice edges of a block that carry a vertex: bit p of axis[d] is the edge from point p along axis d.
struct EdgeMasks {
    BlockMask axis[3];
    MENISCUS_HD int count() const { return popcount(axis[0]) + popcount(axis[1]) + popcount(axis[2]); }
};

/// Arrays of one element per stored block unless said otherwise.
struct BlocksView {
    BrickGridView grid;
    std::uint32_t count = 0;
    const std::uint32_t* brick = nullptr;  ///< index of its brick
    const std::uint16_t* place = nullptr;  ///< index_in_brick
    std::uint8_t* level = nullptr;         ///< 1, 2, 3; 0 outside the surface band
    BlockMask* sampled = nullptr;          ///< the block's points with a field value
    BlockMask* inside = nullptr;           ///< the block's points inside the fluid
    std::uint32_t* first_sample = nullptr;
    float* samples = nullptr;  ///< field values, a block's in the order of its points
    EdgeMasks* edges = nullptr;
    std::uint32_t* first_vertex = nullptr;

    MENISCUS_HD Int3 coordinate(std::uint32_t block) const {
        return grid.bricks[brick[block]].corner() + place_in_brick(place[block]);
    }
    /// Offsets of -1, 0 or 1 a side; no_index where no block is stored, that is, where the field is zero.
    MENISCUS_HD std::uint32_t neighbor(std::uint32_t block, const Int3& offset) const {
        return grid.neighbor(brick[block], place[block], offset);
    }
    MENISCUS_HD int level_or_none(std::uint32_t block) const { return block == no_index ? 0 : level[block]; }
    MENISCUS_HD BlockMask inside_or_none(std::uint32_t block) const { return block == no_index ? 0 : inside[block]; }
    /// Field value at a sampled point of a block.
    MENISCUS_HD float value(std::uint32_t block, int bit) const {
        return samples[first_sample[block] +
                       static_cast<std::uint32_t>(popcount(sampled[block] & ((BlockMask{1} << bit) - 1)))];
    }
};

MENISCUS_HD constexpr Int3 axis_offset(int axis, int distance = 1) {
    return {axis == 0 ? distance : 0, axis == 1 ? distance : 0, axis == 2 ? distance : 0};
}

/// A block and the seven that hold the points on its cell's upper faces: index dx + 2 dy + 4 dz.
struct ClosedCell {
    std::uint32_t block[8];

    ClosedCell() = default;
    MENISCUS_HD ClosedCell(const BlocksView& blocks, std::uint32_t own) {
        for (int row = 0; row < 4; ++row) {
            const auto pair = blocks.grid.neighbor_pair(blocks.brick[own], blocks.place[own], {0, row & 1, row >> 1});
            block[2 * row] = pair.first;
            block[2 * row + 1] = pair.second;
        }
    }
    /// The block that owns a point of the closed cell, coordinates 0 to 4.
    MENISCUS_HD std::uint32_t owner(int x, int y, int z) const { return block[x >> 2 | (y >> 2) << 1 | (z >> 2) << 2]; }
    MENISCUS_HD static int bit(int x, int y, int z) { return point_bit(x & 3, y & 3, z & 3); }
    MENISCUS_HD bool inside(const BlocksView& blocks, int x, int y, int z) const {
        return (blocks.inside_or_none(owner(x, y, z)) >> bit(x, y, z) & 1) != 0;
    }
};

}  // namespace meniscus
