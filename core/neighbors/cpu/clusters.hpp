// Blocks in clusters, as many as a register has lanes: neighbors share most of the particles near them, so that
// visiting them together lets one search serve all. Clusters come in groups, for the same reason.
#pragma once

#include <cstddef>
#include <cstdint>

#include "field/lanes.hpp"
#include "lattice/brick_grid.hpp"

namespace meniscus::cpu {

/// Edge of a group in base cells: its clusters are visited one after the other.
inline constexpr int group_size = 4;
/// Edges of a cluster in base cells.
inline constexpr Int3 cluster_size{WideLanes::count / 4, 2, 2};
inline constexpr int cluster_blocks = WideLanes::count;

/// The base cells of a cluster from its lowest.
inline constexpr Int3 cluster_step(int i) {
    return {i % cluster_size.x, i / cluster_size.x & 1, i / cluster_size.x >> 1};
}
/// The lowest base cell of the group that holds one.
inline constexpr Int3 group_corner(const Int3& base_cell) {
    return {base_cell.x & -group_size, base_cell.y & -group_size, base_cell.z & -group_size};
}
/// The lowest base cell of the cluster that holds one.
inline constexpr Int3 cluster_corner(const Int3& base_cell) {
    return {base_cell.x & -cluster_size.x, base_cell.y & -cluster_size.y, base_cell.z & -cluster_size.z};
}

/// Calls visit(lowest base cell of the cluster inside the brick) for every cluster of a brick that holds one of some
/// cells. cells: bits as those of Brick::occupied.
template <class Visit>
void for_each_cluster(const std::uint64_t* cells, const Visit& visit) {
    constexpr int rows = 4;  // rows of clusters in a group
    for (int group_z = 0; group_z < brick_size; group_z += group_size)
        for (int group_y = 0; group_y < brick_size; group_y += group_size) {
            const auto y_of = [&](int row) { return group_y + 2 * (row & 1); };
            const auto z_of = [&](int row) { return group_z + 2 * (row >> 1); };
            std::uint64_t any[rows];
            for (int row = 0; row < rows; ++row) {
                const auto cells_at = [&](int dy, int dz) {
                    const int index = (y_of(row) + dy) << 4 | (z_of(row) + dz) << 8;
                    return cells[index >> 6] >> (index & 63) & 0xFFFF;
                };
                any[row] = cells_at(0, 0) | cells_at(1, 0) | cells_at(0, 1) | cells_at(1, 1);
            }
            constexpr std::uint64_t cluster = (std::uint64_t{1} << cluster_size.x) - 1;
            for (int group_x = 0; group_x < brick_size; group_x += group_size)
                for (int row = 0; row < rows; ++row)
                    for (int x = group_x; x < group_x + group_size; x += cluster_size.x)
                        if ((any[row] >> x & cluster) != 0) visit(Int3{x, y_of(row), z_of(row)});
        }
}

/// Calls visit(number) for those of some members of a brick that are in the cluster at `corner`.
template <class Visit>
void for_each_member(const Brick& brick, const std::uint64_t* cells, const Int3& corner, const Visit& visit) {
    for (int i = 0; i < cluster_blocks; ++i) {
        const int index = index_in_brick(corner + cluster_step(i));
        if ((cells[index >> 6] >> (index & 63) & 1) != 0) visit(brick.number(index));
    }
}

}  // namespace meniscus::cpu
