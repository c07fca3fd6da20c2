// Base vertices are sampled for all stored cells, before the band is known.
#include "engine/cuda/candidates.hpp"
#include "engine/cuda/long_loop.hpp"
#include "engine/cuda/warp.hpp"
#include "steps/cuda_steps.hpp"
#include "steps/sample_field/sample_field.hpp"

namespace meniscus::cuda {
namespace {

/// The cells of a brick that a warp takes together, since the same particles are near them: 4 x 2 x 2.
struct BaseCluster {
    static constexpr unsigned cells = warp_threads / 2;
    static constexpr unsigned of_brick = brick_volume / cells;

    /// Of the clusters of a brick, by (z, y, x): the lowest cell's place in the brick.
    __device__ static Int3 corner(unsigned cluster) {
        return {static_cast<int>(cluster % 4 * 4), static_cast<int>(cluster / 4 % 8 * 2),
                static_cast<int>(cluster / 32 * 2)};
    }
    /// A cell's place in the cluster.
    __device__ static Int3 step(unsigned cell) {
        return {static_cast<int>(cell % 4), static_cast<int>(cell / 4 % 2), static_cast<int>(cell / 8 % 2)};
    }
    /// The smallest box around a set of cells, units from the cluster's corner.
    __device__ static UnitBox box(unsigned set) {
        constexpr float edge = units_per_base_cell;
        const unsigned layers = set | set >> 8;
        const unsigned row = (layers | layers >> 4) & 0xF;
        return {{edge * static_cast<float>(lowest_bit(row)), (layers & 0x0F) != 0 ? 0.0F : edge,
                 (set & 0x00FF) != 0 ? 0.0F : edge},
                {edge * static_cast<float>(highest_bit(row) + 1), (layers & 0xF0) != 0 ? 2 * edge : edge,
                 (set & 0xFF00) != 0 ? 2 * edge : edge}};
    }
};

/// A warp for every cluster, and two lanes for every cell: one sums the value at the base vertex, the other the bound
/// of the cell. A value is the bound of a box without extent, bit by bit.
template <class Kernel>
__global__ void __launch_bounds__(block_threads, 4) sample_base(const __grid_constant__ State f) {
    __shared__ ParticleStaging<Kernel> staging[block_warps];
    // What is sampled later is appended.
    const std::uint32_t blocks = f.count(Resource::blocks);
    if (blockIdx.x == 0 && threadIdx.x == 0) {
        f.need(Resource::samples, blocks);
        f.counts->field_evaluations = blocks;
    }
    const std::uint32_t bricks = blocks <= f.capacity[Resource::samples] ? f.count(Resource::bricks) : 0;
    const unsigned cell = lane_index() % BaseCluster::cells;
    const bool bounds = lane_index() >= BaseCluster::cells;
    const Int3 step = BaseCluster::step(cell);
    LongLoop loop(f);
    each_by_warp(BaseCluster::of_brick * bricks, [&](std::uint32_t i) {
        const Brick& brick = f.bricks[i / BaseCluster::of_brick];
        const Int3 corner = BaseCluster::corner(i % BaseCluster::of_brick);
        const int place = index_in_brick(corner + step);
        const bool exists = brick.holds(place);
        const unsigned set = __ballot_sync(all_lanes, exists ? 1 : 0) & ((1U << BaseCluster::cells) - 1);
        if (set == 0 || !loop.goes_on_together()) return;
        constexpr float edge = units_per_base_cell;
        const float half = bounds ? edge / 2 : 0.0F;
        const float x = static_cast<float>(step.x) * edge + half, y = static_cast<float>(step.y) * edge + half,
                    z = static_cast<float>(step.z) * edge + half;
        float sum = 0.0F, closest = 0.0F;
        for_each_staged_candidate<Kernel>(
            f, base_cell_origin(brick.corner() + corner), BaseCluster::box(set), staging[warp_in_block()],
            [&](const OneCandidate& c) { sum_bounds<Kernel>(c.view(), x, y, z, half, sum, closest); });
        if (!exists) return;
        const std::uint32_t b = brick.number(place);
        if (bounds) {
            f.reaches[b] = {sum, closest};
            return;
        }
        const bool allowed =
            !f.settings.has_domain ||
            (domain_points(brick.corner() + corner + step, f.settings.domain_low, f.settings.domain_high) & 1) != 0;
        f.samples[b] = sum;
        f.first_sample[b] = b;
        f.sampled[b] = 1;
        f.inside[b] = allowed && sum > f.settings.iso ? 1 : 0;
    });
}

}  // namespace

void sample_base_vertices(const State& state, const Launcher& launch) {
    const std::uint64_t clusters = BaseCluster::of_brick * state.capacity[Resource::bricks];
    with_kernel(state.settings, [&]<class Kernel>() { launch(clusters, block_warps, sample_base<Kernel>, state); });
}

}  // namespace meniscus::cuda
