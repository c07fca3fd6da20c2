// Clusters of base cells near each other, which a warp takes together, since the same particles are near them.
#pragma once

#include "engine/cuda/state.hpp"

namespace meniscus::cuda {

/// X x Y x Z cells: powers of two that divide a brick's.
template <int X, int Y, int Z>
struct CellCluster {
    static constexpr unsigned cells = X * Y * Z;
    static constexpr std::uint64_t of_brick =
        brick_volume / cells;  ///< clusters in a brick; in all bricks there may be more than 2^32

    std::uint32_t brick;
    Int3 corner;  ///< the lowest cell

    /// The i-th of all bricks' clusters, by (z, y, x) in a brick.
    __device__ CellCluster(const State& state, std::uint64_t i)
        : brick(static_cast<std::uint32_t>(i / of_brick)),
          corner(state.bricks[brick].corner() + Int3{static_cast<int>(i % a_row) * X,
                                                     static_cast<int>(i / a_row % a_column) * Y,
                                                     static_cast<int>(i % of_brick / (a_row * a_column)) * Z}) {}

    /// A cell's place in a cluster, x running first.
    __device__ static Int3 step(unsigned cell) {
        return {static_cast<int>(cell % X), static_cast<int>(cell / X % Y), static_cast<int>(cell / (X * Y) % Z)};
    }
    /// Whether such a cell is stored.
    __device__ bool holds(const State& state, const Int3& step) const { return state.bricks[brick].holds(place(step)); }
    /// The block of a stored cell.
    __device__ std::uint32_t block(const State& state, const Int3& step) const {
        return state.bricks[brick].number(place(step));
    }

    /// The cluster's box, in units from its corner.
    __device__ static UnitBox box() { return {{0.0F, 0.0F, 0.0F}, {X * base_edge, Y * base_edge, Z * base_edge}}; }

private:
    static constexpr unsigned a_row = brick_size / X;
    static constexpr unsigned a_column = brick_size / Y;

    __device__ int place(const Int3& step) const { return index_in_brick(corner + step); }
};

}  // namespace meniscus::cuda
