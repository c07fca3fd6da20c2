// The signs of all blocks' sampled points as sets, to pass over the cells that the surface cannot touch 64 at a time.
#pragma once

#include <cstdint>

#include "lattice/blocks.hpp"
#include "lattice/cell_set.hpp"
#include "lattice/host_device.hpp"

namespace meniscus {

/// Sets of blocks by the signs of their sampled points. Where no block is stored, all points are outside.
struct SignSets {
    CellSetView any_inside;
    CellSetView all_inside;

    /// The cells on whose closed box the sampled points show both signs.
    MENISCUS_HD std::uint64_t cells_seeing_both(std::uint32_t brick, int w) const {
        std::uint64_t any = 0;
        std::uint64_t all = ~std::uint64_t{0};
        for (int i = 0; i < 8; ++i) {
            const Int3 step{i & 1, i >> 1 & 1, i >> 2};
            any |= any_inside.moved(brick, w, step);
            all &= all_inside.moved(brick, w, step);
        }
        return any & ~all;
    }
    /// The blocks with both signs among their points and those one block up an axis.
    MENISCUS_HD std::uint64_t blocks_seeing_both(std::uint32_t brick, int w) const {
        std::uint64_t any = any_inside.word(brick, w);
        std::uint64_t all = all_inside.word(brick, w);
        for (int axis = 0; axis < 3; ++axis) {
            any |= any_inside.moved(brick, w, axis_offset(axis));
            all &= all_inside.moved(brick, w, axis_offset(axis));
        }
        return any & ~all;
    }
};

}  // namespace meniscus
