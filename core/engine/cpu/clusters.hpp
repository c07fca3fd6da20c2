// Blocks in clusters of 2 x 2 x 2: neighbors share most of the particles near them, so that visiting them together lets
// one search serve eight.
#pragma once

#include <cstddef>
#include <cstdint>

#include "lattice/brick_grid.hpp"

namespace meniscus::cpu {

/// The eight base cells of a cluster from its lowest.
inline constexpr Int3 cluster_step(int i) {
    return {i & 1, i >> 1 & 1, i >> 2};
}

/// Calls visit(lowest base cell of the cluster inside the brick) for every cluster of a brick that holds one of some
/// cells. cells: bits as those of Brick::occupied.
template <class Visit>
void for_each_cluster(const std::uint64_t* cells, const Visit& visit) {
    for (int z = 0; z < brick_size; z += 2)
        for (int y = 0; y < brick_size; y += 2) {
            const auto row = [&](int dy, int dz) {
                const int index = (y + dy) << 4 | (z + dz) << 8;
                return cells[index >> 6] >> (index & 63) & 0xFFFF;
            };
            const std::uint64_t any = row(0, 0) | row(1, 0) | row(0, 1) | row(1, 1);
            for (std::uint64_t pairs = (any | any >> 1) & 0x5555; pairs != 0; pairs &= pairs - 1)
                visit(Int3{lowest_bit(pairs), y, z});
        }
}

/// Calls visit(number) for those of some members of a brick that are in the cluster at `corner`.
template <class Visit>
void for_each_member(const Brick& brick, const std::uint64_t* cells, const Int3& corner, const Visit& visit) {
    for (int i = 0; i < 8; ++i) {
        const int index = index_in_brick(corner + cluster_step(i));
        if ((cells[index >> 6] >> (index & 63) & 1) != 0) visit(brick.number(index));
    }
}

}  // namespace meniscus::cpu
