// The lattice behind the mesh, kept on the GPU: a thread block for every brick, a thread for every block of it.
#include "steps/keep_lattice/keep_lattice.hpp"

#include "engine/cuda/block_sums.hpp"
#include "engine/cuda/warp.hpp"
#include "steps/cuda_steps.hpp"

namespace meniscus::cuda {
namespace {

/// The places of a brick that its cells' points lie in, and the levels of these cells: in shared memory.
struct BrickPlaces {
    static constexpr unsigned border = ClosedArray<std::uint8_t>::border;
    /// Of 32 bits: shared memory has no atomic operation on 64, which is a loop there.
    static constexpr unsigned words = (closed_places + 31) / 32;
    static_assert(words <= block_threads);

    std::uint32_t place[words];                        ///< set of places
    std::uint32_t before[words];                       ///< number of places in the words before
    std::uint32_t rows[brick_size * brick_size / 32];  ///< set of rows, y + 16 z, with cells that draw
    std::uint32_t levels;
    std::uint32_t blocks;  ///< number of places
    Counter first;         ///< index of the first block
    std::uint8_t level[closed_places + 2 * border];
    /// Counts of as many successive places as a warp has lanes; then of all places before these.
    std::uint32_t of_warp[words][BrickTotals::count];
    BlockSums<1> one_sum;
    BlockSums<BrickTotals::count> sums;

    __device__ void clear() {
        for (unsigned i = threadIdx.x; i < words; i += block_threads) place[i] = 0;
        for (unsigned i = threadIdx.x; i < sizeof(rows) / sizeof(*rows); i += block_threads) rows[i] = 0;
        for (unsigned i = threadIdx.x; i < sizeof(level); i += block_threads) level[i] = 0;
        if (threadIdx.x == 0) levels = 0;
    }
    __device__ void add_cell(int at, int its_level) {
        level[border + static_cast<unsigned>(at)] = static_cast<std::uint8_t>(its_level);
        for (int i = 0; i < 8; ++i) {
            const auto p = static_cast<unsigned>(at + closed_steps(i));
            atomicOr(&place[p / 32], 1U << p % 32);
        }
        const Int3 in_brick = closed_coordinate(at);
        const auto row = static_cast<unsigned>(in_brick.y + brick_size * in_brick.z);
        atomicOr(&rows[row / 32], 1U << row % 32);
    }
    /// Counts the places.
    __device__ void count() {
        std::uint32_t own[1] = {threadIdx.x < words ? static_cast<std::uint32_t>(__popc(place[threadIdx.x])) : 0};
        std::uint32_t all[1];
        one_sum.sum_below(own, all);
        if (threadIdx.x < words) before[threadIdx.x] = own[0];
        if (threadIdx.x == 0) blocks = all[0];
    }
    /// The i-th place; there are more than i.
    __device__ int nth(std::uint32_t i) const {
        unsigned low = 0;
        for (unsigned high = words; high - low > 1;) {
            const unsigned middle = (low + high) / 2;
            (before[middle] <= i ? low : high) = middle;
        }
        return static_cast<int>(32 * low) + nth_bit(place[low], static_cast<int>(i - before[low]));
    }
    /// Sums up the counts of warps, of which there are `warps`; returns all places' in `all`.
    __device__ void add_up(std::uint32_t warps, std::uint32_t (&all)[BrickTotals::count]) {
        std::uint32_t own[BrickTotals::count] = {};
        for (unsigned n = 0; threadIdx.x < warps && n < BrickTotals::count; ++n) own[n] = of_warp[threadIdx.x][n];
        sums.sum_below(own, all);
        for (unsigned n = 0; threadIdx.x < warps && n < BrickTotals::count; ++n) of_warp[threadIdx.x][n] = own[n];
        __syncthreads();
    }
    __device__ LevelsAround around(int at) const {
        return LevelsAround::from(
            [&](int i) { return int{level[static_cast<unsigned>(at - closed_steps(i) + static_cast<int>(border))]}; });
    }
    __device__ std::uint32_t row_count() const {
        std::uint32_t n = 0;
        for (const std::uint32_t word : rows) n += static_cast<std::uint32_t>(__popc(word));
        return n;
    }
};

/// The stored blocks at the places of a closed brick.
struct ClosedBrick {
    const BlocksView& blocks;
    std::uint32_t brick;

    __device__ std::uint32_t block(const Int3& at) const {
        const auto beyond = [](int coordinate) { return coordinate == brick_size ? 1 : 0; };
        const Int3 step{beyond(at.x), beyond(at.y), beyond(at.z)};
        return blocks.grid.neighbor(brick, index_in_brick(at - step), step);
    }
    /// 0 beyond the closed brick.
    __device__ BlockMask inside(const Int3& at) const {
        if (at.x > brick_size || at.y > brick_size || at.z > brick_size) return 0;
        return blocks.inside_or_none(block(at));
    }
};

/// draws(), for a cell whose triangles are counted: one that sees both signs has some.
__device__ bool has_triangles(const State& state, std::uint32_t cell, int level) {
    return state.triangles_before[cell].of[level - 1] != state.triangles_before[cell + 1].of[level - 1];
}

/// The faces of a cell on those of its brick that see both signs, as bits 2 axis + side.
__device__ unsigned outer_mixed_faces(const ClosedBrick& brick, const Int3& at, int level) {
    if (level < 2) return 0;
    unsigned faces = 0;
    for (int face = 0; face < 6; ++face) {
        if (!is_outer_face(at, face)) continue;
        const int axis = face >> 1;
        const Int3 upper = at + axis_offset(axis, face & 1);
        const Int3 u = axis_offset((axis + 1) % 3);
        const Int3 v = axis_offset((axis + 2) % 3);
        const FaceSigns signs(brick.inside(upper), brick.inside(upper + u), brick.inside(upper + v),
                              brick.inside(upper + u + v), axis, level_stride(level));
        if (signs.mixed() != 0) faces |= 1U << face;
    }
    return faces;
}

/// The host's copy of a block's facts.
__device__ LatticeBlock lattice_block(const BlocksView& blocks, std::uint32_t number, int place, int level) {
    LatticeBlock block{};
    block.place = static_cast<std::uint16_t>(place);
    block.level = static_cast<std::uint8_t>(level);
    if (number == no_index) return block;
    block.inside = blocks.inside[number];
    for (std::size_t axis = 0; axis < 3; ++axis) block.edges[axis] = blocks.edges[number].axis[axis];
    block.first_vertex = blocks.first_vertex[number];
    if (level != 0) block.coarser = static_cast<std::uint8_t>(coarser_beyond_brick(blocks, number, level));
    return block;
}

/// All but `before`.
__device__ KeptBlock kept_block(const ClosedBrick& brick, const LatticeBlock& block, const LevelsAround& around) {
    const Int3 at = closed_coordinate(block.place);
    KeptBlock kept;
    kept.corners = corner_points(around);
    const BlockMask next[3] = {brick.inside(at + axis_offset(0)), brick.inside(at + axis_offset(1)),
                               brick.inside(at + axis_offset(2))};
    BlockMask inside = block.inside & kept.corners;
    find_brick_edges(around, kept.corners, next, [&](BlockMask points) { return block.inside & points; },
                     {inside, kept.middles, kept.quarters, kept.edges});
    kept.outer_faces = outer_mixed_faces(brick, at, block.level);
    return kept;
}

__device__ BrickTotals totals_of(const std::uint32_t (&counts)[BrickTotals::count]) {
    return {counts[0], counts[1], counts[2], counts[3], counts[4]};
}

/// The counts of the blocks that the lanes below have; those of all lanes go to `all`.
__device__ BrickTotals counts_below(const LatticeBlock& block, const KeptBlock& kept,
                                    std::uint32_t (&all)[BrickTotals::count]) {
    std::uint32_t own[] = {static_cast<std::uint32_t>(popcount(kept.corners)),
                           static_cast<std::uint32_t>(popcount(kept.middles) + popcount(kept.quarters)),
                           static_cast<std::uint32_t>(kept.edges.count()), block.level != 0 ? 1U : 0U,
                           static_cast<std::uint32_t>(popcount(kept.outer_faces))};
    for (unsigned n = 0; n < BrickTotals::count; ++n) {
        std::uint32_t total = 0;
        own[n] = sum_of_lanes_below(own[n], total);
        if (lane_index() == 0) all[n] = total;
    }
    return totals_of(own);
}

__global__ void __launch_bounds__(block_threads) keep_bricks(const __grid_constant__ State state) {
    __shared__ BrickPlaces places;
    const BlocksView blocks = state.blocks();
    const std::uint32_t bricks = state.count(Resource::bricks);
    for (std::uint32_t b = blockIdx.x; b < bricks; b += gridDim.x) {
        const ClosedBrick brick{blocks, b};
        places.clear();
        __syncthreads();
        const std::uint32_t end = b + 1 < bricks ? state.bricks[b + 1].first : blocks.count;
        std::uint32_t levels = 0;
        for (std::uint32_t cell = state.bricks[b].first + threadIdx.x; cell < end; cell += block_threads) {
            const int level = blocks.level[cell];
            if (level == 0 || !has_triangles(state, cell, level)) continue;
            places.add_cell(closed_place_of(blocks.place[cell]), level);
            levels |= 1U << level;
        }
        if (levels != 0) atomicOr(&places.levels, levels);
        __syncthreads();
        places.count();
        if (threadIdx.x == 0)
            places.first =
                atomicAdd(&state.counts->needed[static_cast<int>(Resource::lattice_blocks)], Counter{places.blocks});
        __syncthreads();
        const Counter first = places.first;
        const bool has_room = first + places.blocks <= state.capacity[Resource::lattice_blocks];
        const std::uint32_t count = has_room ? places.blocks : 0;
        for (std::uint32_t w = same_in_all_lanes(warp_in_block()); warp_threads * w < count; w += block_warps) {
            const std::uint32_t i = warp_threads * w + lane_index();
            LatticeBlock block{};
            KeptBlock kept;
            if (i < count) {
                const int place = places.nth(i);
                const LevelsAround around = places.around(place);
                const int level = places.level[BrickPlaces::border + static_cast<unsigned>(place)];
                block = lattice_block(blocks, brick.block(closed_coordinate(place)), place, level);
                kept = kept_block(brick, block, around);
            }
            kept.before = counts_below(block, kept, places.of_warp[w]);
            if (i >= count) continue;
            state.lattice_blocks[first + i] = block;
            state.kept_blocks[first + i] = kept;
        }
        __syncthreads();
        std::uint32_t all[BrickTotals::count];
        places.add_up((count + warp_threads - 1) / warp_threads, all);
        // By the thread that has written the block.
        for (std::uint32_t i = threadIdx.x; i < count; i += block_threads)
            state.kept_blocks[first + i].before += totals_of(places.of_warp[i / warp_threads]);
        if (threadIdx.x == 0)
            state.kept_bricks[b] = {static_cast<std::uint32_t>(first), places.blocks, places.row_count(), places.levels,
                                    totals_of(all)};
        // The next brick takes the place of this one.
        __syncthreads();
    }
}

/// One thread: whether there was room for the blocks.
__global__ void require_room_for_lattice(const __grid_constant__ State state) {
    if (blockIdx.x != 0 || threadIdx.x != 0) return;
    state.need(Resource::lattice_blocks, state.counts->needed[static_cast<int>(Resource::lattice_blocks)]);
}

}  // namespace

void keep_lattice(const State& state, const Launcher& launch) {
    launch(state.capacity[Resource::bricks], 1, keep_bricks, state);
    launch(1, block_threads, require_room_for_lattice, state);
}

}  // namespace meniscus::cuda
