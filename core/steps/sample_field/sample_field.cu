// Step 4 on the GPU: a warp for every cluster of blocks.
#include "steps/sample_field/sample_field.hpp"

#include "engine/cuda/cluster.hpp"
#include "engine/cuda/particle_field.hpp"
#include "engine/cuda/warp.hpp"
#include "steps/adjust_levels/sweeps.hpp"
#include "steps/cuda_steps.hpp"
#include "steps/sample_field/stale_cells.hpp"

namespace meniscus::cuda {
namespace {

/// Lists the clusters of blocks with wanted points that have no value. Blocks that gain points move to new room at the
/// end of the samples; their old room stays unused until the next frame. A block for which there is no room is left
/// out. All lanes of a warp call it, each with one block or none; no block is given twice.
__device__ inline void list_if_wanted(const State& f, List list, std::uint32_t b, BlockMask wanted) {
    BlockMask missing = 0;
    BlockMask sampled = 0;
    if (b != no_index) {
        sampled = f.sampled[b];
        f.wanted_points[b] = wanted;
        missing = wanted & ~sampled;
    }
    const std::uint32_t room = missing == 0 ? 0 : static_cast<std::uint32_t>(popcount(missing | sampled));
    const Counter first = take_places(&f.counts->needed[static_cast<int>(Resource::samples)], room);
    const bool fits = room != 0 && first + room <= f.capacity[Resource::samples];
    if (fits) {
        f.old_first_sample[b] = f.first_sample[b];
        f.first_sample[b] = static_cast<std::uint32_t>(first);
    } else if (room != 0) {
        f.wanted_points[b] = sampled;
    }
    list_clusters(f, list, b, fits);
}
/// The same for all blocks, by the whole grid; wanted(block) is asked once for each.
template <class Wanted>
__device__ void list_wanted_points(const State& f, List list, const Wanted& wanted) {
    const BlocksView blocks = f.blocks();
    GridLoop{}.each_together(blocks.count, [&](std::uint32_t b, bool exists) {
        list_if_wanted(f, list, exists ? b : no_index, exists ? wanted(blocks, b) : 0);
    });
}

/// The levels around a block, which eight neighboring lanes give: each looks at one of the eight cells.
__device__ inline LevelsAround levels_around_together(const BlocksView& blocks, std::uint32_t block) {
    const unsigned lane = lane_index();
    const Int3 offset = LevelsAround::offset(static_cast<int>(lane % 8));
    const int level = block == no_index ? 0 : blocks.level_or_none(blocks.neighbor(block, offset));
    LevelsAround around;
    for (int l = 1; l <= 3; ++l)
        around.at_least[l] = static_cast<int>(__ballot_sync(all_lanes, level >= l ? 1 : 0) >> (lane & ~7U) & 0xFF);
    return around;
}

/// Shared memory of a warp that samples a cluster.
template <class Field>
struct ClusterSampling {
    typename Field::Shared near;
    std::uint32_t bits[warp_threads];  ///< of a block's missing points, where they are few
};

/// A block's points, of which a lane has two: `lane` and lane + 32.
struct HalfMasks {
    unsigned half[2];

    __device__ explicit HalfMasks(BlockMask points)
        : half{static_cast<unsigned>(points), static_cast<unsigned>(points >> 32)} {}
    __device__ unsigned count() const { return static_cast<unsigned>(__popc(half[0]) + __popc(half[1])); }
    __device__ bool holds(int h) const { return (half[h] >> lane_index() & 1) != 0; }
    /// Points before this lane's.
    __device__ unsigned before(int h) const {
        const auto in_half = lanes_below(half[h]);
        return h == 0 ? in_half : in_half + static_cast<unsigned>(__popc(half[0]));
    }
};

/// All lanes of a warp give values to a block's wanted points that have none; samples lie in the order of points, signs
/// follow. step: the block's offset in its cluster.
template <class Field, class Near>
__device__ void sample_block(const State& f, Near& near, const BlocksView& blocks, std::uint32_t block,
                             const Int3& step, ClusterSampling<Field>& shared) {
    const unsigned lane = lane_index();
    const HalfMasks missing(f.wanted_points[block] & ~blocks.sampled[block]);
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
    float fresh[2];  // of points `lane` and lane + 32
    const float z = coordinate(2);
    near.column(box, coordinate(0), coordinate(1), z, z + static_cast<float>(2 * units_per_cell), are_many, fresh);
    // Read anew: while particles were summed over, registers were dear.
    const BlockMask known_points = blocks.sampled[block];
    const BlockMask sampled_points = known_points | f.wanted_points[block];
    const HalfMasks known(known_points);
    const HalfMasks sampled(sampled_points);
    if (!are_many) {
        const HalfMasks added(sampled_points & ~known_points);
        const float value = fresh[0];
        for (int h = 0; h < 2; ++h)
            fresh[h] = __shfl_sync(all_lanes, value, static_cast<int>(added.before(h) % warp_threads));
    }
    const std::uint32_t old = f.old_first_sample[block];
    const std::uint32_t first = f.first_sample[block];
    BlockMask above = 0;
    for (int h = 0; h < 2; ++h) {
        bool is_above = false;
        if (sampled.holds(h)) {
            const float value = known.holds(h) ? f.samples[old + known.before(h)] : fresh[h];
            f.samples[first + sampled.before(h)] = value;
            is_above = value > f.settings.iso;
        }
        above |= static_cast<BlockMask>(__ballot_sync(all_lanes, is_above ? 1 : 0)) << (32 * h);
    }
    if (lane == 0) {
        f.sampled[block] = sampled_points;
        f.inside[block] = f.settings.has_domain ? above & domain_points(blocks.coordinate(block), f.settings.domain_low,
                                                                        f.settings.domain_high)
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
__device__ void sample_listed(const State& f, const Field& field, List list,
                              ClusterSampling<Field> (&shared)[block_warps]) {
    const BlocksView blocks = f.blocks();
    std::uint32_t evaluations = 0;  // a warp's are fewer than all samples
    each_listed_cluster(f, blocks, list, [&](const Cluster& cluster) {
        cluster.unmark(f);
        const BlockMask missing =
            cluster.block == no_index ? 0 : f.wanted_points[cluster.block] & ~blocks.sampled[cluster.block];
        evaluations += static_cast<std::uint32_t>(popcount(missing));
        ClusterSampling<Field>& own = shared[warp_in_block()];
        auto near = field.near(f, cluster, box_of_points(missing, cluster_step(lane_index())), own.near);
        for (unsigned left = __ballot_sync(all_lanes, missing != 0 ? 1 : 0); left != 0; left &= left - 1) {
            const auto k = static_cast<unsigned>(lowest_bit(left));
            sample_block(f, near, blocks, __shfl_sync(all_lanes, cluster.block, static_cast<int>(k)), cluster_step(k),
                         own);
        }
    });
    add_of_lanes(&f.counts->field_evaluations, evaluations);
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

/// Three blocks hide what a warp waits for, if registers suffice; on some GPUs shared memory has room for two.
#if defined(__CUDA_ARCH__) && (__CUDA_ARCH__ == 860 || __CUDA_ARCH__ == 890)
template <class Field>
inline constexpr int blocks_of_sampling = 2;
#else
template <class Field>
inline constexpr int blocks_of_sampling = Field::has_own_supports ? 3 : 2;
#endif

template <class Field>
__global__ void __launch_bounds__(block_threads, blocks_of_sampling<Field>)
    sample_list(const __grid_constant__ State f, const Field field, List list) {
    __shared__ ClusterSampling<Field> shared[block_warps];
    sample_listed(f, field, list, shared);
}

/// A cell's face in Counts::faces_to_settle.
struct ListedFace {
    std::uint32_t block;
    unsigned face;

    __device__ explicit ListedFace(std::uint64_t entry)
        : block(static_cast<std::uint32_t>(entry)), face(static_cast<unsigned>(entry >> 32)) {}
    __device__ static std::uint64_t entry(std::uint32_t block, unsigned face) {
        return block | std::uint64_t{face} << 32;
    }
};

/// The settling of the band, which all threads of the grid go through.
template <Slivers slivers>
class Settling {
public:
    __device__ explicit Settling(const State& f)
        : f_(f), blocks_(f.blocks()), sweeps_(f, Team::grid(), StaleCells(f)) {}

    /// Lists the faces at which a cell may go up by what is sampled so far.
    __device__ void begin() {
        const LevelSets levels = f_.level_sets();
        Team::grid().each_part<CellFace::count>(
            std::uint64_t{Brick::words} * f_.count(Resource::bricks), [&](std::uint64_t i, unsigned face) {
                const auto word = static_cast<std::uint32_t>(i);
                if (face == 0) f_.is_stale()[word] = 0;
                const Brick& brick = f_.bricks[word / Brick::words];
                const std::uint32_t w = word % Brick::words;
                std::uint64_t cells = brick.occupied[w];
                if (cells != 0)
                    cells &= levels.below(word / Brick::words, static_cast<int>(w), CellFace(face).offset());
                if (cells == 0) return;
                std::uint32_t at = atomicAdd(&f_.counts->faces_to_settle, static_cast<std::uint32_t>(popcount(cells)));
                for (; cells != 0; cells &= cells - 1)
                    f_.faces_to_settle()[at++] =
                        ListedFace::entry(brick.number(static_cast<int>(64 * w) + lowest_bit(cells)), face);
            });
        sweeps_.team.wait();
        faces_ = static_cast<volatile std::uint32_t&>(f_.counts->faces_to_settle);
    }

    /// Raises the cells that the rules find, adjusts, and lists what to sample then; returns whether there were any.
    /// The first block does it alone where a wait of the grid would cost more than the work.
    __device__ bool raise() {
        sweeps_.team = Team::fit_for(tests(), 1);
        std::uint32_t found = 0;
        if (sweeps_.team.has_this_thread()) {
            const std::uint32_t search = sweeps_.search();
            test_faces(true);
            test_stale_cells(true);
            found = sweeps_.end_search();
            if (found == 0 && !sweeps_.team.is_alone()) return false;
            if (found != 0) raise_found(found, search);
            if (sweeps_.team.is_first_thread()) f_.counts->is_settled = found == 0 ? 1 : 0;
        }
        Team::grid().wait();
        if (static_cast<volatile std::uint32_t&>(f_.counts->is_settled) != 0) return false;
        faces_ = 0;
        stale_count_ = sweeps_.places.count();
        GridLoop{}.each_together<std::uint64_t>(std::uint64_t{8} * stale_count_, [&](std::uint64_t i, bool exists) {
            const std::uint32_t block = exists ? sweeps_.places[i / 8] : no_index;
            const BlockMask wanted = corner_points(levels_around_together(blocks_, block));
            const bool is_first = exists && i % 8 == 0;
            if (is_first) f_.corner_points[block] = wanted;
            list_if_wanted(f_, List::later_round, is_first ? block : no_index, wanted);
        });
        Team::grid().wait();
        return true;
    }

private:
    __device__ std::uint64_t tests() const { return faces_ + std::uint64_t{CellFace::count} * stale_count_; }

    /// Both rules look at the same levels. A cell that joins the band changes what slivers there are: they are looked
    /// for anew.
    __device__ void test(std::uint32_t block, const CellFace& face, bool joins) const {
        if (f_.level[block] == 0) {
            if (!joins || !joins_band(blocks_, block, face)) return;
            f_.counts->last_joining = sweeps_.search();
        } else if (slivers == Slivers::kept || !misses_surface(blocks_, block, face)) {
            return;
        }
        sweeps_.find(block);
    }
    __device__ void test_faces(bool joins) const {
        sweeps_.team.loop().each(faces_, [&](std::uint32_t i) {
            const ListedFace listed(f_.faces_to_settle()[i]);
            test(listed.block, CellFace(listed.face), joins);
        });
    }
    __device__ void test_stale_cells(bool joins) const {
        sweeps_.team.each_part<CellFace::count>(
            stale_count_, [&](std::uint64_t i, unsigned face) { test(sweeps_.places[i], CellFace(face), joins); });
    }
    __device__ void raise_found(std::uint32_t found, std::uint32_t search) {
        sweeps_.team = sweeps_.team.narrowed_to(std::uint64_t{neighbor_slots} * found, 4);
        if (!sweeps_.team.has_this_thread()) return;
        // All have read the last round's list.
        if (sweeps_.team.is_first_thread()) f_.counts->listed[static_cast<int>(List::later_round)] = 0;
        if (static_cast<volatile std::uint32_t&>(f_.counts->last_joining) == search) {
            sweeps_.raise_found(found,
                                [&](std::uint32_t block) { return f_.level[block] == 0 ? f_.wanted_level[block] : 0; });
            stale_count_ = sweeps_.places.count();
            test_faces(false);
            test_stale_cells(false);
            found = sweeps_.end_search();
        }
        sweeps_.raise_found(found, [&](std::uint32_t block) { return f_.level[block] + 1; });
        sweeps_.adjust_levels();
    }

    const State& f_;
    BlocksView blocks_;
    Sweeps<StaleCells> sweeps_;
    std::uint32_t faces_ = 0;        ///< to be tested in the first round
    std::uint32_t stale_count_ = 0;  ///< when the round began
};

/// Takes the cells into the band that a neighbor's samples show to hold surface, raises those that would cut off a
/// finer neighbor's surface in a sliver, adjusts and samples, until there are none.
template <Slivers slivers, class Field>
__global__ void __launch_bounds__(block_threads, 2) settle_band(const __grid_constant__ State f, const Field field) {
    __shared__ ClusterSampling<Field> shared[block_warps];
    Settling<slivers> settling(f);
    settling.begin();
    while (settling.raise()) {
        sample_listed(f, field, List::later_round, shared);
        Team::grid().wait();
        if (!f.goes_on()) return;
    }
}

}  // namespace

template <Slivers slivers, class Field>
void sample_field(const State& state, const Field& field, const Launcher& launch) {
    const std::uint64_t blocks = state.capacity[Resource::blocks];
    launch(blocks, block_threads, list_corner_points, state);
    launch(blocks, block_warps, sample_list<Field>, state, field, List::corner_points);
    // Several threads take parts of one block's work.
    launch.cooperative(4 * blocks, settle_band<slivers, Field>, state, field);
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
