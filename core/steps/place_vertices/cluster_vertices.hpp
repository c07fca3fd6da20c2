// The vertices of a cluster of blocks one after another, so that those of several blocks fill a warp.
#pragma once

#include "engine/cuda/warp.hpp"
#include "neighbors/cuda/cluster.hpp"

namespace meniscus::cuda {

class ClusterVertices {
public:
    /// The place of a vertex.
    struct Place {
        Int3 step;  ///< offset of its block in the cluster
        std::uint32_t block;
        int i;                 ///< index among its block's vertices
        std::uint32_t number;  ///< index among all vertices
    };

    /// All lanes of a warp call it.
    __device__ ClusterVertices(const BlocksView& blocks, const Cluster& cluster)
        : lowest(cluster.coordinate(blocks)), block_(cluster.block) {
        std::uint32_t own = 0;
        if (block_ != no_index) {
            own = static_cast<std::uint32_t>(blocks.edges[block_].count());
            first_ = blocks.first_vertex[block_];
        }
        below_ = sum_of_lanes_below(own, count);
        const Int3 step = cluster_step(lane_index());
        // By axis: whether there are vertices in the lower half, and in the upper.
        const unsigned halves = reduce_or(own == 0 ? 0 : 1U << step.x | 4U << step.y | 16U << step.z);
        for (int axis = 0; axis < 3; ++axis) {
            box.low[axis] = (halves >> 2 * axis & 1) != 0 ? 0.0F : base_edge;
            box.high[axis] = (halves >> 2 * axis & 2) != 0 ? 2.0F * base_edge : base_edge;
        }
    }
    /// The place of vertex i < count; all lanes of a warp call it.
    __device__ Place place(std::uint32_t i) const {
        const unsigned owner = lane_with(i, below_);
        const auto from = [owner](std::uint32_t value) {
            return __shfl_sync(all_lanes, value, static_cast<int>(owner));
        };
        const std::uint32_t in_block = i - from(below_);
        return {cluster_step(owner), from(block_), static_cast<int>(in_block), from(first_) + in_block};
    }

    Int3 lowest;  ///< lowest base cell
    std::uint32_t count = 0;
    UnitBox box;  ///< box of the blocks with vertices, units from the lowest's corner

private:
    std::uint32_t block_;      ///< this lane's block
    std::uint32_t below_ = 0;  ///< number of vertices in the blocks of lower lanes
    std::uint32_t first_ = 0;  ///< index of the first vertex of this lane's block
};

}  // namespace meniscus::cuda
