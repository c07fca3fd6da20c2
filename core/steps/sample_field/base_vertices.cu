// Base vertices are sampled for all stored cells, before the band is known.
#include "engine/cuda/long_loop.hpp"
#include "engine/cuda/warp.hpp"
#include "neighbors/cuda/box_neighbors.hpp"
#include "neighbors/cuda/cell_cluster.hpp"
#include "steps/cuda_steps.hpp"
#include "steps/sample_field/sample_field.hpp"

namespace meniscus::cuda {
namespace {

using BaseCluster = CellCluster<4, 2, 2>;
static_assert(2 * BaseCluster::cells == warp_threads);

/// A warp for every cluster, and two lanes for every cell: one sums the value at the base vertex, the other the bound
/// of the cell. A value is the bound of a box without extent, bit by bit.
template <class Kernel>
__global__ void __launch_bounds__(block_threads, 3) sample_base(const __grid_constant__ State state) {
    __shared__ BoxNeighbors<Kernel, 3> neighbors[block_warps];
    // Later samples are appended.
    const std::uint32_t blocks = state.count(Resource::blocks);
    if (blockIdx.x == 0 && threadIdx.x == 0) {
        state.counts->needed[static_cast<int>(Resource::samples)] = blocks;
        state.counts->field_evaluations = blocks;
    }
    const std::uint32_t bricks = blocks <= state.capacity[Resource::samples] ? state.count(Resource::bricks) : 0;
    const bool bounds = lane_index() >= BaseCluster::cells;
    const float half = bounds ? base_edge / 2 : 0.0F;
    const Int3 step = BaseCluster::step(lane_index() % BaseCluster::cells);
    const float x = static_cast<float>(step.x) * base_edge + half, y = static_cast<float>(step.y) * base_edge + half,
                z = static_cast<float>(step.z) * base_edge + half;
    LongLoop loop(state);
    each_by_warp(BaseCluster::of_brick * bricks, [&](std::uint64_t i) {
        const BaseCluster cluster(state, i);
        const bool exists = cluster.holds(state, step);
        if (__ballot_sync(all_lanes, exists ? 1 : 0) == 0 || !loop.goes_on_together()) return;
        float sum = 0.0F, closest = 0.0F;
        neighbors[warp_in_block()].for_each(
            state, cluster.brick, cluster.corner, cluster.box(),
            [&](const Neighbor& neighbor) { sum_bounds<Kernel>(neighbor.view(), x, y, z, half, sum, closest); });
        if (!exists) return;
        const std::uint32_t b = cluster.block(state, step);
        if (bounds) {
            state.reaches[b] = {sum, closest};
            return;
        }
        const bool allowed =
            !state.settings.has_domain ||
            (domain_points(cluster.corner + step, state.settings.domain_low, state.settings.domain_high) & 1) != 0;
        state.samples[b] = sum;
        state.first_sample[b] = b;
        state.sampled[b] = 1;
        state.inside[b] = allowed && sum > state.settings.iso ? 1 : 0;
    });
    state.require_room_at_end(RoomFinder::base_samples, Resource::samples);
}

}  // namespace

void sample_base_vertices(const State& state, const Launcher& launch) {
    const std::uint64_t clusters = BaseCluster::of_brick * state.capacity[Resource::bricks];
    with_kernel(state.settings, [&]<class Kernel>() { launch(clusters, block_warps, sample_base<Kernel>, state); });
}

}  // namespace meniscus::cuda
