// Step 4 on the GPU: a warp for every cluster of blocks.
#include "steps/sample_field/sample_field.hpp"

#include "engine/cuda/block_counter.hpp"
#include "engine/cuda/warp.hpp"
#include "neighbors/cuda/cluster.hpp"
#include "neighbors/cuda/particle_field.hpp"
#include "steps/cuda_steps.hpp"
#include "steps/sample_field/settling.hpp"
#include "steps/sample_field/wanted_points.hpp"

namespace meniscus::cuda {
namespace {

/// Shared memory of a warp that samples a cluster.
template <class Field>
struct ClusterSampling {
    typename Field::Shared near;
    std::uint32_t bits[warp_threads];  ///< bits of a block's missing points, where they are few
};

/// A block's points, of which a lane has two: `lane` and lane + 32.
struct HalfMasks {
    unsigned half[2];

    __device__ explicit HalfMasks(BlockMask points)
        : half{static_cast<unsigned>(points), static_cast<unsigned>(points >> 32)} {}
    __device__ unsigned count() const { return static_cast<unsigned>(__popc(half[0]) + __popc(half[1])); }
    __device__ bool holds(int h) const { return (half[h] >> lane_index() & 1) != 0; }
    /// Number of points before this lane's.
    __device__ unsigned before(int h) const {
        const auto in_half = lanes_below(half[h]);
        return h == 0 ? in_half : in_half + static_cast<unsigned>(__popc(half[0]));
    }
};

/// All lanes of a warp give values to a block's wanted points that have none; samples lie in the order of points, signs
/// follow. step: the block's offset in its cluster.
template <class Field, class Near>
__device__ void sample_block(const State& state, Near& near, const BlocksView& blocks, std::uint32_t block,
                             const Int3& step, ClusterSampling<Field>& shared) {
    const unsigned lane = lane_index();
    const HalfMasks missing(state.wanted_points[block] & ~blocks.sampled[block]);
    const float corner[3] = {static_cast<float>(step.x * units_per_base_cell),
                             static_cast<float>(step.y * units_per_base_cell),
                             static_cast<float>(step.z * units_per_base_cell)};
    UnitBox box;
    const auto span = [&](int axis, unsigned low, unsigned others) {
        box.low[axis] = corner[axis] + (low != 0 ? 0.0F : static_cast<float>(units_per_cell));
        box.high[axis] = corner[axis] + (others != 0 ? static_cast<float>(3 * units_per_cell) : 0.0F);
    };
    const unsigned in_either = missing.half[0] | missing.half[1];
    constexpr auto low_x = static_cast<unsigned>(low_face(0));
    constexpr auto low_y = static_cast<unsigned>(low_face(1));
    constexpr auto low_z = static_cast<unsigned>(low_face(2));
    span(0, in_either & low_x, in_either & ~low_x);
    span(1, in_either & low_y, in_either & ~low_y);
    span(2, missing.half[0] & low_z, (missing.half[0] & ~low_z) | missing.half[1]);
    // All 64 points, which cost no more than those beyond 32; or one for each lane.
    const unsigned count = missing.count();
    const bool are_many = count > warp_threads;
    const unsigned place[2] = {missing.before(0), missing.before(1)};
    unsigned bit = lane;
    if (!are_many) {
        for (int h = 0; h < 2; ++h)
            if (missing.holds(h)) shared.bits[place[h]] = lane + 32U * static_cast<unsigned>(h);
        __syncwarp();
        // Lanes without a point repeat the first.
        bit = shared.bits[lane < count ? lane : 0];
        // The next block's take the place of this one's.
        __syncwarp();
    }
    const auto coordinate = [&](int axis) {
        return corner[axis] + static_cast<float>(point_coordinate(static_cast<int>(bit), axis) * units_per_cell);
    };
    float fresh[2];  // values at points `lane` and lane + 32
    const float z = coordinate(2);
    near.column(box, coordinate(0), coordinate(1), z, z + static_cast<float>(2 * units_per_cell), are_many, fresh);
    // Loaded again: kept across the sum they would cost registers.
    const BlockMask known_points = blocks.sampled[block];
    const BlockMask sampled_points = known_points | state.wanted_points[block];
    const HalfMasks known(known_points);
    const HalfMasks sampled(sampled_points);
    if (!are_many) {
        const HalfMasks added(sampled_points & ~known_points);
        const float value = fresh[0];
        for (int h = 0; h < 2; ++h)
            fresh[h] = __shfl_sync(all_lanes, value, static_cast<int>(added.before(h) % warp_threads));
    }
    const std::uint32_t old = state.old_first_sample[block];
    const std::uint32_t first = state.first_sample[block];
    BlockMask above = 0;
    for (int h = 0; h < 2; ++h) {
        bool is_above = false;
        if (sampled.holds(h)) {
            const float value = known.holds(h) ? state.samples[old + known.before(h)] : fresh[h];
            state.samples[first + sampled.before(h)] = value;
            is_above = value > state.settings.iso;
        }
        above |= static_cast<BlockMask>(__ballot_sync(all_lanes, is_above ? 1 : 0)) << (32 * h);
    }
    if (lane == 0) {
        state.sampled[block] = sampled_points;
        state.inside[block] =
            state.settings.has_domain
                ? above & domain_points(blocks.coordinate(block), state.settings.domain_low, state.settings.domain_high)
                : above;
    }
}

/// The box of the missing points of a cluster's blocks, of which each lane holds its own.
__device__ inline UnitBox box_of_points(BlockMask missing, const Int3& step) {
    // A set of coordinates, eight for an axis.
    unsigned slabs = 0;
    const int steps[3] = {step.x, step.y, step.z};
    for (int axis = 0; axis < 3; ++axis) {
        const BlockMask low = missing & low_face(axis);
        const unsigned own = (low != 0 ? 1U : 0U) | (low != missing ? 0b1110U : 0U);
        slabs |= own << (8 * axis + base_cell_size * steps[axis]);
    }
    slabs = reduce_or(slabs);
    UnitBox box;
    for (int axis = 0; axis < 3; ++axis) {
        const unsigned of_axis = slabs >> 8 * axis & 0xFF;
        box.low[axis] = static_cast<float>(lowest_bit(of_axis) * units_per_cell);
        box.high[axis] = static_cast<float>(highest_bit(of_axis) * units_per_cell);
    }
    return box;
}

template <class Field>
__device__ void sample_listed(const State& state, const Field& field, List list,
                              ClusterSampling<Field> (&shared)[block_warps], BlockCounter& counter) {
    const BlocksView blocks = state.blocks();
    std::uint32_t evaluations = 0;  // the evaluations of a lane are fewer than all samples
    each_listed_cluster(state, blocks, list, [&](const Cluster& cluster) {
        cluster.unmark(state);
        const BlockMask missing =
            cluster.block == no_index ? 0 : state.wanted_points[cluster.block] & ~blocks.sampled[cluster.block];
        evaluations += static_cast<std::uint32_t>(popcount(missing));
        ClusterSampling<Field>& own = shared[warp_in_block()];
        auto near = field.near(state, cluster, box_of_points(missing, cluster_step(lane_index())), own.near);
        for (unsigned left = __ballot_sync(all_lanes, missing != 0 ? 1 : 0); left != 0; left &= left - 1) {
            const auto k = static_cast<unsigned>(lowest_bit(left));
            sample_block(state, near, blocks, __shfl_sync(all_lanes, cluster.block, static_cast<int>(k)),
                         cluster_step(k), own);
        }
    });
    counter.add(&state.counts->field_evaluations, Counter{evaluations});
}

__global__ void __launch_bounds__(block_threads, 4) list_corner_points(const __grid_constant__ State state) {
    __shared__ BlockCounter counter;
    list_wanted_points(state, List::corner_points, counter, [&](const BlocksView& blocks, std::uint32_t b) {
        return state.corner_points[b] = corner_points(LevelsAround(blocks, b));
    });
}

__global__ void __launch_bounds__(block_threads, 4) list_edge_middles(const __grid_constant__ State state) {
    __shared__ BlockCounter counter;
    list_wanted_points(state, List::edge_middles, counter, [&](const BlocksView& blocks, std::uint32_t b) {
        return state.corner_points[b] == 0 || blocks.sampled[b] == ~BlockMask{0}
                   ? 0
                   : edge_middles(blocks, b, LevelsAround(blocks, b));
    });
}

__global__ void __launch_bounds__(block_threads) list_half_edge_middles(const __grid_constant__ State state) {
    __shared__ BlockCounter counter;
    list_wanted_points(state, List::half_edge_middles, counter, [&](const BlocksView& blocks, std::uint32_t b) {
        return half_edge_middles(blocks.inside[b], state.wanted_points[b] & level1_middles);
    });
}

/// Three blocks hide the waits of a warp, if registers suffice; on some GPUs shared memory has room for two.
#if defined(__CUDA_ARCH__) && (__CUDA_ARCH__ == 860 || __CUDA_ARCH__ == 890)
template <class Field>
inline constexpr int blocks_of_sampling = 2;
#else
template <class Field>
inline constexpr int blocks_of_sampling = Field::has_own_supports ? 3 : 2;
#endif

template <class Field>
__global__ void __launch_bounds__(block_threads, blocks_of_sampling<Field>)
    sample_list(const __grid_constant__ State state, const Field field, List list, RoomFinder kernel) {
    __shared__ ClusterSampling<Field> shared[block_warps];
    __shared__ BlockCounter counter;
    sample_listed(state, field, list, shared, counter);
    state.require_room_at_end(kernel, Resource::samples);
}

/// Takes the cells into the band that a neighbor's samples show to hold surface, raises those that would cut off a
/// finer neighbor's surface in a sliver, adjusts and samples, until there are none.
template <Slivers slivers, class Field>
__global__ void __launch_bounds__(block_threads, 2)
    settle_band(const __grid_constant__ State state, const Field field) {
    __shared__ ClusterSampling<Field> shared[block_warps];
    __shared__ BlockCounter counter;
    Settling<slivers> settling(state);
    settling.begin();
    while (settling.raise()) {
        sample_listed(state, field, List::later_round, shared, counter);
        // All blocks have begun: they have waited for each other.
        if (blockIdx.x == 0 && threadIdx.x == 0)
            state.need(Resource::samples, state.counts->needed[static_cast<int>(Resource::samples)]);
        Team::grid().wait();
        if (!state.goes_on()) return;
    }
}

}  // namespace

template <Slivers slivers, class Field>
void sample_field(const State& state, const Field& field, const Launcher& launch) {
    const std::uint64_t blocks = state.capacity[Resource::blocks];
    launch.prefer_shared_memory(sample_list<Field>);
    launch.prefer_shared_memory(settle_band<slivers, Field>);
    launch(blocks, block_threads, list_corner_points, state);
    launch(blocks, block_warps, sample_list<Field>, state, field, List::corner_points, RoomFinder::corner_samples);
    // Several threads take parts of one block's work.
    launch.cooperative(4 * blocks, settle_band<slivers, Field>, state, field);
}

template <class Field>
void sample_edge_middles(const State& state, const Field& field, const Launcher& launch) {
    const std::uint64_t blocks = state.capacity[Resource::blocks];
    launch(blocks, block_threads, list_edge_middles, state);
    launch(blocks, block_warps, sample_list<Field>, state, field, List::edge_middles, RoomFinder::middle_samples);
    launch(blocks, block_threads, list_half_edge_middles, state);
    launch(blocks, block_warps, sample_list<Field>, state, field, List::half_edge_middles,
           RoomFinder::half_edge_samples);
}

template void sample_field<Slivers::raised>(const State&, const ParticleField<CubicSpline>&, const Launcher&);
template void sample_field<Slivers::raised>(const State&, const ParticleField<Poly6>&, const Launcher&);
template void sample_edge_middles(const State&, const ParticleField<CubicSpline>&, const Launcher&);
template void sample_edge_middles(const State&, const ParticleField<Poly6>&, const Launcher&);

}  // namespace meniscus::cuda
