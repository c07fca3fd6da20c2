// Step 4 on the GPU: a warp for every block.
#include "steps/sample_field/sample_field.hpp"

#include "engine/cuda/long_loop.hpp"
#include "engine/cuda/particle_field.hpp"
#include "engine/cuda/warp.hpp"
#include "steps/adjust_levels/sweeps.hpp"
#include "steps/cuda_steps.hpp"

namespace meniscus::cuda {
namespace {

/// Blocks that gain points move to new room at the end of the samples; their old room stays unused until the next
/// frame. wanted(block) is asked once for every block. Blocks for which there is no room are left out.
template <class Wanted>
__device__ void list_wanted_points(const State& f, List list, const Wanted& wanted) {
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
        f.chosen[at] = b;
    });
}

/// Values of G points of a block for each lane; lanes without a point repeat another's.
template <int G, class Field>
__device__ void point_values(const State& f, const Field& field, const Int3& at, const UnitBox& box,
                             const int (&bit)[G], typename Field::Staging& staging, float (&value)[G]) {
    float x[G], y[G], z[G];
    for (int g = 0; g < G; ++g) {
        x[g] = static_cast<float>(point_coordinate(bit[g], 0) * units_per_cell);
        y[g] = static_cast<float>(point_coordinate(bit[g], 1) * units_per_cell);
        z[g] = static_cast<float>(point_coordinate(bit[g], 2) * units_per_cell);
    }
    field.template values<G>(f, at, box, staging, x, y, z, value);
}

/// Shared memory of a warp that samples a block.
template <class Field>
struct BlockSampling {
    typename Field::Staging staging;
    float fresh[64];
};

/// All lanes of a warp give values to a block's wanted points that have none; samples lie in the order of points, signs
/// follow. Returns how many there were.
template <class Field>
__device__ int sample_block(const State& f, const Field& field, const BlocksView& blocks, std::uint32_t block,
                            BlockSampling<Field>& shared) {
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
        point_values<2>(f, field, at, box, bits, shared.staging, sums);
        shared.fresh[lane] = sums[0];
        shared.fresh[lane + 32] = sums[1];
    } else {
        const int bits[1] = {bit_of(lane)};
        float sums[1];
        point_values<1>(f, field, at, box, bits, shared.staging, sums);
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

template <class Field>
__device__ void sample_listed(const State& f, const Field& field, List list,
                              BlockSampling<Field> (&shared)[block_warps]) {
    const BlocksView blocks = f.blocks();
    Counter evaluations = 0;
    LongLoop loop(f);
    each_by_warp(f.listed(list), [&](std::uint32_t i) {
        if (!loop.goes_on_together()) return;
        evaluations += static_cast<Counter>(sample_block(f, field, blocks, f.chosen[i], shared[warp_in_block()]));
    });
    if (lane_index() == 0 && evaluations != 0) atomicAdd(&f.counts->field_evaluations, evaluations);
    if (blockIdx.x == 0 && threadIdx.x == 0)
        f.need(Resource::samples, f.counts->needed[static_cast<int>(Resource::samples)]);
}

__global__ void __launch_bounds__(block_threads) list_corner_points(const __grid_constant__ State f) {
    list_wanted_points(f, List::corner_points, [&](const BlocksView& blocks, std::uint32_t b) {
        return f.corner_points[b] = corner_points(LevelsAround(blocks, b));
    });
}

__global__ void __launch_bounds__(block_threads, 4) list_edge_middles(const __grid_constant__ State f) {
    list_wanted_points(f, List::edge_middles, [&](const BlocksView& blocks, std::uint32_t b) {
        return f.corner_points[b] == 0 || blocks.sampled[b] == ~BlockMask{0}
                   ? 0
                   : edge_middles(blocks, b, LevelsAround(blocks, b));
    });
}

__global__ void __launch_bounds__(block_threads) list_half_edge_middles(const __grid_constant__ State f) {
    list_wanted_points(f, List::half_edge_middles, [&](const BlocksView& blocks, std::uint32_t b) {
        return half_edge_middles(blocks.inside[b], f.wanted_points[b] & level1_middles);
    });
}

template <class Field>
__global__ void __launch_bounds__(block_threads, 2)
    sample_list(const __grid_constant__ State f, const Field field, List list) {
    __shared__ BlockSampling<Field> shared[block_warps];
    sample_listed(f, field, list, shared);
}

/// Takes the cells into the band that a neighbor's samples show to hold surface, raises those that would cut off a
/// finer neighbor's surface in a sliver, adjusts and samples, until there are none.
template <Slivers slivers, class Field>
__global__ void __launch_bounds__(block_threads, 2) settle_band(const __grid_constant__ State f, const Field field) {
    __shared__ BlockSampling<Field> shared[block_warps];
    Sweeps sweeps(f);
    for (;;) {
        const bool grown = sweeps.raise_blocks(
            [&](const BlocksView& blocks, std::uint32_t b) { return blocks.level[b] == 0 && joins_band(blocks, b); },
            [&](std::uint32_t b) { return f.wanted_level[b]; });
        bool raised = false;
        if constexpr (slivers == Slivers::raised)
            raised = sweeps.raise_blocks(
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
        sample_listed(f, field, List::later_round, shared);
        sweeps.wait();
        if (!f.goes_on()) return;
    }
}

}  // namespace

template <Slivers slivers, class Field>
void sample_field(const State& state, const Field& field, const Launcher& launch) {
    const std::uint64_t blocks = state.capacity[Resource::blocks];
    launch(blocks, block_threads, list_corner_points, state);
    launch(blocks, block_warps, sample_list<Field>, state, field, List::corner_points);
    launch.cooperative(blocks, settle_band<slivers, Field>, state, field);
}

template <class Field>
void sample_edge_middles(const State& state, const Field& field, const Launcher& launch) {
    const std::uint64_t blocks = state.capacity[Resource::blocks];
    launch(blocks, block_threads, list_edge_middles, state);
    launch(blocks, block_warps, sample_list<Field>, state, field, List::edge_middles);
    launch(blocks, block_threads, list_half_edge_middles, state);
    launch(blocks, block_warps, sample_list<Field>, state, field, List::half_edge_middles);
}

template void sample_field<Slivers::raised>(const State&, const ParticleField<CubicSpline>&, const Launcher&);
template void sample_field<Slivers::raised>(const State&, const ParticleField<Poly6>&, const Launcher&);
template void sample_edge_middles(const State&, const ParticleField<CubicSpline>&, const Launcher&);
template void sample_edge_middles(const State&, const ParticleField<Poly6>&, const Launcher&);

}  // namespace meniscus::cuda
