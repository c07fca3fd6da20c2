// Once the band of a part of a frame has settled: hashes of what this part and its neighbors must agree on, and the way
// back to the part's own cells, of which alone the mesh is made. (core/README.md#parts-that-are-put-together)
#pragma once

#include <cstdint>

#include "lattice/blocks.hpp"
#include "lattice/host_device.hpp"
#include "lattice/lattice_part.hpp"
#include "lattice/raise_times.hpp"
#include "lattice/word_hash.hpp"

namespace meniscus {

/// Whether one of a brick and the brick at a neighbor slot is the part's own and the other is not.
MENISCUS_HD inline bool is_seam(const LatticePart& part, const Int3& brick, int slot) {
    return part.owns_brick(brick) != part.owns_brick(brick + neighbor_offset(slot));
}

/// The cells of a brick that touch the brick at a neighbor slot: a layer, a row, or one.
struct FacingCells {
    Int3 first, size;

    MENISCUS_HD explicit FacingCells(int slot) {
        const Int3 offset = neighbor_offset(slot);
        const auto start = [](int d) { return d > 0 ? brick_size - 1 : 0; };
        const auto span = [](int d) { return d == 0 ? brick_size : 1; };
        first = {start(offset.x), start(offset.y), start(offset.z)};
        size = {span(offset.x), span(offset.y), span(offset.z)};
    }
    MENISCUS_HD int count() const { return size.x * size.y * size.z; }
    /// Index in the brick of the i-th.
    MENISCUS_HD int place(int i) const {
        return index_in_brick(first + Int3{i % size.x, i / size.x % size.y, i / (size.x * size.y)});
    }
};

/// Adds what a cell beside a seam has come to: its level, the moments at which it reached it, and the signs of those of
/// its corners that its own block holds. A cell outside of the band whose lowest corner is outside of the fluid adds
/// nothing, as does one that is not stored. place: index in the brick. slot: where the other brick is.
MENISCUS_HD inline void add_cell_beside_seam(WordHash& hash, const BlocksView& blocks, const RaiseTimes* times,
                                             std::uint32_t brick, int place, int slot) {
    const Brick& members = blocks.grid.bricks[brick];
    if (!members.holds(place)) return;
    const std::uint32_t block = members.number(place);
    const int level = blocks.level[block];
    const BlockMask corners = level == 0 ? BlockMask{1} : stride_points(level_stride(level));
    const BlockMask signs = blocks.inside[block] & corners;
    if (level == 0 && signs == 0) return;
    constexpr std::uint64_t words = 5;
    const auto side = static_cast<std::uint64_t>(slot > own_slot ? 0 : brick_volume);
    const std::uint64_t at = words * (side + static_cast<std::uint64_t>(place));
    hash.add(static_cast<std::uint64_t>(level), at);
    hash.add(signs, at + 1);
    for (int i = 0; i < 3; ++i) hash.add(times[block].at[i], at + 2 + static_cast<std::uint64_t>(i));
}

}  // namespace meniscus
