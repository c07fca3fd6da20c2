#include "steps/sample_field/sample_field.hpp"

#include "engine/cuda/candidates.hpp"
#include "engine/cuda/warp.hpp"
#include "steps/adjust_levels/sweeps.hpp"
#include "steps/cuda_steps.hpp"

namespace meniscus::cuda {
namespace {

/// One thread for every block: base vertices lie as far apart as particles, so that few of them share any.
__global__ void __launch_bounds__(block_threads, 3) sample_base(const __grid_constant__ Frame f) {
    const BlocksView blocks = f.blocks();
    // What is sampled later is appended.
    if (blockIdx.x == 0 && threadIdx.x == 0) {
        f.need(Resource::samples, blocks.count);
        f.counts->field_evaluations = blocks.count;
    }
    const std::uint32_t count = blocks.count <= f.capacity[Resource::samples] ? blocks.count : 0;
    GridLoop{}.each(count, [&](std::uint32_t b) {
        const Int3 at = blocks.coordinate(b);
        constexpr float edge = units_per_base_cell;
        const float zero[1] = {0.0F};
        float value[1] = {0.0F};
        float bound = 0.0F;
        float closest = 0.0F;
        for_each_candidate(f, base_cell_origin(at), {{0.0F, 0.0F, 0.0F}, {edge, edge, edge}},
                           [&](const OneCandidate& c) {
                               sum_values<1>(c.view(), zero, zero, zero, value);
                               sum_bounds(c.view(), edge / 2, edge / 2, edge / 2, edge / 2, bound, closest);
                           });
        const bool allowed =
            !f.settings.has_domain || (domain_points(at, f.settings.domain_low, f.settings.domain_high) & 1) != 0;
        f.samples[b] = value[0];
        f.reaches[b] = {bound, closest};
        f.first_sample[b] = b;
        f.sampled[b] = 1;
        f.inside[b] = allowed && value[0] > f.settings.iso ? 1 : 0;
    });
}

/// Blocks that gain points move to new room at the end of the samples; their old room stays unused until the next
/// frame. wanted(block) is asked once for every block. Blocks for which there is no room are left out.
template <class Wanted>
__device__ void list_wanted_points(const Frame& f, List list, const Wanted& wanted) {
    const BlocksView blocks = f.blocks();
    GridLoop{}.each_together(blocks.count, [&](std::uint32_t b, bool exists) {
        BlockMask missing = 0;
        std::uint32_t room = 0;
        if (exists) {
            f.wanted_points[b] = wanted(blocks, b);
            missing = f.wanted_points[b] & ~blocks.sampled[b];
            if (missing != 0) room = static_cast<std::uint32_t>(popcount(missing | blocks.sampled[b]));
        }
        const Counter first = take_places(&f.counts->needed[static_cast<int>(Resource::samples)], room);
        const bool fits = room != 0 && first + room <= f.capacity[Resource::samples];
        const std::uint32_t at = take_places(&f.counts->listed[static_cast<int>(list)], fits ? 1 : 0);
        if (!fits) return;
        f.old_first_sample[b] = f.first_sample[b];
        f.first_sample[b] = static_cast<std::uint32_t>(first);
        f.work[at] = b;
    });
}

/// Values of G points for each lane; lanes without a point repeat another's.
template <int G>
__device__ void sum_points(const Frame& f, const Int3& at, const UnitBox& box, const int (&bit)[G], Staging& staging,
                           float (&sum)[G]) {
    float x[G], y[G], z[G];
    for (int g = 0; g < G; ++g) {
        x[g] = static_cast<float>(point_coordinate(bit[g], 0) * units_per_cell);
        y[g] = static_cast<float>(point_coordinate(bit[g], 1) * units_per_cell);
        z[g] = static_cast<float>(point_coordinate(bit[g], 2) * units_per_cell);
        sum[g] = 0.0F;
    }
    for_each_staged_candidate(f, base_cell_origin(at), box, staging,
                              [&](const OneCandidate& c) { sum_values<G>(c.view(), x, y, z, sum); });
}

/// Shared memory of a warp that samples a block.
struct BlockSampling {
    Staging staging;
    float fresh[64];
};

/// All lanes of a warp give values to a block's wanted points that have none; samples lie in the order of points, signs
/// follow. Returns how many there were.
__device__ int sample_block(const Frame& f, const BlocksView& blocks, std::uint32_t block, BlockSampling& shared) {
    const int lane = static_cast<int>(lane_index());
    const Int3 at = blocks.coordinate(block);
    const BlockMask known = blocks.sampled[block];
    const BlockMask missing = f.wanted_points[block] & ~known;
    const BlockMask sampled = known | missing;
    const int count = popcount(missing);
    UnitBox box;
    for (int axis = 0; axis < 3; ++axis) {
        const unsigned slabs = occupied_slabs(missing, axis);
        box.low[axis] = static_cast<float>(lowest_bit(slabs) * units_per_cell);
        box.high[axis] = static_cast<float>(highest_bit(slabs) * units_per_cell);
    }
    const auto bit_of = [&](int i) { return nth_bit(missing, i < count ? i : 0); };
    if (count > static_cast<int>(warp_threads)) {
        const int bits[2] = {bit_of(lane), bit_of(lane + 32)};
        float sums[2];
        sum_points<2>(f, at, box, bits, shared.staging, sums);
        shared.fresh[lane] = sums[0];
        shared.fresh[lane + 32] = sums[1];
    } else {
        const int bits[1] = {bit_of(lane)};
        float sums[1];
        sum_points<1>(f, at, box, bits, shared.staging, sums);
        shared.fresh[lane] = sums[0];
    }
    __syncwarp();
    const float* const old = f.samples + f.old_first_sample[block];
    float* const samples = f.samples + f.first_sample[block];
    BlockMask above = 0;
    for (int half = 0; half < 2; ++half) {
        const int bit = lane + 32 * half;
        const BlockMask before = (BlockMask{1} << bit) - 1;
        bool is_above = false;
        if ((sampled >> bit & 1) != 0) {
            const float value =
                (known >> bit & 1) != 0 ? old[popcount(known & before)] : shared.fresh[popcount(missing & before)];
            samples[popcount(sampled & before)] = value;
            is_above = value > f.settings.iso;
        }
        above |= static_cast<BlockMask>(__ballot_sync(all_lanes, is_above ? 1 : 0)) << (32 * half);
    }
    if (lane == 0) {
        f.sampled[block] = sampled;
        f.inside[block] =
            f.settings.has_domain ? above & domain_points(at, f.settings.domain_low, f.settings.domain_high) : above;
    }
    // The next block's values take the place of this one's.
    __syncwarp();
    return count;
}

__device__ void sample_listed(const Frame& f, List list, BlockSampling (&shared)[block_warps]) {
    const BlocksView blocks = f.blocks();
    Counter evaluations = 0;
    each_by_warp(f.listed(list), [&](std::uint32_t i) {
        evaluations += static_cast<Counter>(sample_block(f, blocks, f.work[i], shared[warp_in_block()]));
    });
    if (lane_index() == 0 && evaluations != 0) atomicAdd(&f.counts->field_evaluations, evaluations);
    if (blockIdx.x == 0 && threadIdx.x == 0)
        f.need(Resource::samples, f.counts->needed[static_cast<int>(Resource::samples)]);
}

__global__ void __launch_bounds__(block_threads) list_corner_points(const __grid_constant__ Frame f) {
    list_wanted_points(f, List::corner_points, [&](const BlocksView& blocks, std::uint32_t b) {
        return f.corner_points[b] = corner_points(LevelsAround(blocks, b));
    });
}

__global__ void __launch_bounds__(block_threads, 4) list_edge_middles(const __grid_constant__ Frame f) {
    list_wanted_points(f, List::edge_middles, [&](const BlocksView& blocks, std::uint32_t b) {
        return f.corner_points[b] == 0 || blocks.sampled[b] == ~BlockMask{0}
                   ? 0
                   : edge_middles(blocks, b, LevelsAround(blocks, b));
    });
}

__global__ void __launch_bounds__(block_threads) list_half_edge_middles(const __grid_constant__ Frame f) {
    list_wanted_points(f, List::half_edge_middles, [&](const BlocksView& blocks, std::uint32_t b) {
        return half_edge_middles(blocks.inside[b], f.wanted_points[b] & level1_middles);
    });
}

__global__ void __launch_bounds__(block_threads, 2) sample_list(const __grid_constant__ Frame f, List list) {
    __shared__ BlockSampling shared[block_warps];
    sample_listed(f, list, shared);
}

/// Takes the cells into the band that a neighbor's samples show to hold surface, raises those that would cut off a
/// finer neighbor's surface in a sliver, adjusts and samples, until there are none.
__global__ void __launch_bounds__(block_threads, 2) settle_band(const __grid_constant__ Frame f) {
    __shared__ BlockSampling shared[block_warps];
    Sweeps sweeps(f);
    for (;;) {
        const bool grown = sweeps.raise_blocks(
            [&](const BlocksView& blocks, std::uint32_t b) { return blocks.level[b] == 0 && joins_band(blocks, b); },
            [&](std::uint32_t b) { return f.wanted_level[b]; });
        const bool raised = sweeps.raise_blocks(
            [&](const BlocksView& blocks, std::uint32_t b) { return misses_surface_on_face(blocks, b); },
            [&](std::uint32_t b) { return f.level[b] + 1; });
        if (!grown && !raised) return;
        sweeps.adjust_levels();
        if (sweeps.is_first_thread()) f.counts->listed[static_cast<int>(List::later_round)] = 0;
        sweeps.wait();
        list_wanted_points(f, List::later_round, [&](const BlocksView& blocks, std::uint32_t b) {
            return f.corner_points[b] = corner_points(LevelsAround(blocks, b));
        });
        sweeps.wait();
        sample_listed(f, List::later_round, shared);
        sweeps.wait();
        if (f.counts->overflow != 0) return;
    }
}

}  // namespace

void sample_base_vertices(const Frame& frame, const Launcher& launch) {
    launch(frame.capacity[Resource::blocks], block_threads, sample_base, frame);
}

void sample_field(const Frame& frame, const Launcher& launch) {
    const std::uint64_t blocks = frame.capacity[Resource::blocks];
    launch(blocks, block_threads, list_corner_points, frame);
    launch(blocks, block_warps, sample_list, frame, List::corner_points);
    launch.cooperative(frame.capacity[Resource::blocks], settle_band, frame);
}

void sample_edge_middles(const Frame& frame, const Launcher& launch) {
    const std::uint64_t blocks = frame.capacity[Resource::blocks];
    launch(blocks, block_threads, list_edge_middles, frame);
    launch(blocks, block_warps, sample_list, frame, List::edge_middles);
    launch(blocks, block_threads, list_half_edge_middles, frame);
    launch(blocks, block_warps, sample_list, frame, List::half_edge_middles);
}

}  // namespace meniscus::cuda
