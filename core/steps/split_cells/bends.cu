// Curvature at a point of the surface in every cell of the band, a warp for every cluster of cells and a lane for each.
#include "engine/cuda/block_counter.hpp"
#include "engine/cuda/long_loop.hpp"
#include "engine/cuda/warp.hpp"
#include "neighbors/cuda/box_neighbors.hpp"
#include "neighbors/cuda/cell_cluster.hpp"
#include "steps/cuda_steps.hpp"
#include "steps/split_cells/curvature.hpp"
#include "steps/split_cells/split_cells.hpp"

namespace meniscus::cuda {
namespace {

using BendCluster = CellCluster<4, 4, 2>;
static_assert(BendCluster::cells == warp_threads);

/// The smallest box around the points of some lanes, of which there is one at least.
__device__ UnitBox box_of(const Point3<float>& p, bool counts) {
    constexpr float far = 1e9F;
    const auto least = [&](float v) { return reduce_min(counts ? v : far); };
    const auto greatest = [&](float v) { return reduce_max(counts ? v : -far); };
    return {{least(p.x), least(p.y), least(p.z)}, {greatest(p.x), greatest(p.y), greatest(p.z)}};
}

template <class Kernel>
__global__ void __launch_bounds__(block_threads, 2) measure_band(const __grid_constant__ State state) {
    __shared__ BoxNeighbors<Kernel, 4> neighbors[block_warps];
    __shared__ BlockCounter counter;
    const BlocksView blocks = state.blocks();
    const BlobRule blobs{state.settings.blob_closest, state.settings.blob_level};
    const float iso = state.settings.iso;
    Counter evaluations = 0;
    const Int3 step = BendCluster::step(lane_index());
    // Relative to the corner of the cell's pair of cells a side, as on the CPU: the search meets points that are no
    // whole units.
    const Point3<float> corner{static_cast<float>(step.x & 1) * base_edge, static_cast<float>(step.y & 1) * base_edge,
                               static_cast<float>(step.z & 1) * base_edge};
    LongLoop loop(state);
    each_by_warp(BendCluster::of_brick * state.count(Resource::bricks), [&](std::uint64_t i) {
        const BendCluster cluster(state, i);
        std::uint32_t block = cluster.holds(state, step) ? cluster.block(state, step) : no_index;
        if (block != no_index && state.level[block] == 0) block = no_index;
        const bool is_asked = block != no_index;
        if (__ballot_sync(all_lanes, is_asked ? 1 : 0) == 0 || !loop.goes_on_together()) return;
        CellCorners<float> corners;
        int inside_corners = 0;
        for (float& value : corners.value) value = -iso;
        if (is_asked) {
            const ClosedCell cell(blocks, block);
            for (int k = 0; k < 8; ++k) {
                if (cell.block[k] != no_index) corners.value[k] += blocks.value(cell.block[k], 0);
                inside_corners += static_cast<int>(blocks.inside_or_none(cell.block[k]) & 1);
            }
        }
        // From the corner of the cluster to that of the pairs.
        const float aside[3] = {static_cast<float>(step.x & ~1) * base_edge,
                                static_cast<float>(step.y & ~1) * base_edge,
                                static_cast<float>(step.z & ~1) * base_edge};
        const auto jet_at = [&](const Point3<float>& p) {
            FieldJet<float> jet;
            // Wider by a unit, since the sides of the box are rounded, but no wider than the cluster, which holds all.
            UnitBox box = box_of({p.x + aside[0], p.y + aside[1], p.z + aside[2]}, is_asked);
            for (int axis = 0; axis < 3; ++axis) {
                box.low[axis] = max(box.low[axis] - 1.0F, cluster.box().low[axis]);
                box.high[axis] = min(box.high[axis] + 1.0F, cluster.box().high[axis]);
            }
            neighbors[warp_in_block()].for_each(state, cluster.brick, cluster.corner, box, [&](Neighbor neighbor) {
                // Whole units, so that this is exact.
                neighbor.particle.x -= aside[0];
                neighbor.particle.y -= aside[1];
                neighbor.particle.z -= aside[2];
                sum_jets<Kernel>(neighbor.view(), p.x, p.y, p.z, jet);
            });
            return jet;
        };
        const SurfaceSearch<float> search = search_surface(
            corners, is_mixed(inside_corners) ? 1.0F : 0.0F, corner, iso, jet_at,
            [&](float of_cell) { return __ballot_sync(all_lanes, is_asked && of_cell == 1.0F ? 1 : 0) != 0; });
        if (is_asked)
            state.bends[block] =
                cell_bend(search, inside_corners, blobs.least_level(inside_corners, state.reaches[block]));
        evaluations += is_asked ? (search.again == 1.0F ? 2 : 1) : 0;
    });
    counter.add(&state.counts->field_evaluations, evaluations);
}

}  // namespace

void measure_bends(const State& state, const Launcher& launch) {
    const std::uint64_t clusters = BendCluster::of_brick * state.capacity[Resource::bricks];
    with_kernel(state.settings, [&]<class Kernel>() { launch(clusters, block_warps, measure_band<Kernel>, state); });
}

}  // namespace meniscus::cuda
