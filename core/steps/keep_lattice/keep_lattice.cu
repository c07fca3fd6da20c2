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
    static constexpr unsigned words = ClosedPlaces::words;
    static_assert(words <= block_threads);

    Counter place[words];                              ///< set of places
    std::uint32_t before[words];                       ///< number of places in the words before
    std::uint32_t rows[brick_size * brick_size / 32];  ///< set of rows, y + 16 z, with cells that draw
    std::uint32_t levels;
    std::uint32_t blocks;  ///< number of places
    Counter first;         ///< index of the first block
    std::uint8_t level[closed_places + 2 * border];
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
            atomicOr(&place[p / 64], Counter{1} << p % 64);
        }
        const Int3 in_brick = closed_coordinate(at);
        const auto row = static_cast<unsigned>(in_brick.y + brick_size * in_brick.z);
        atomicOr(&rows[row / 32], 1U << row % 32);
        atomicOr(&levels, 1U << its_level);
    }
    /// Counts the places.
    __device__ void count() {
        std::uint32_t own[1] = {threadIdx.x < words ? static_cast<std::uint32_t>(popcount(place[threadIdx.x])) : 0};
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
        return static_cast<int>(64 * low) + nth_bit(place[low], static_cast<int>(i - before[low]));
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
    LatticeBlock block;
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

__global__ void __launch_bounds__(block_threads) keep_bricks(const __grid_constant__ State state) {
    __shared__ BrickPlaces places;
    const BlocksView blocks = state.blocks();
    const std::uint32_t bricks = state.count(Resource::bricks);
    for (std::uint32_t b = blockIdx.x; b < bricks; b += gridDim.x) {
        const ClosedBrick brick{blocks, b};
        places.clear();
        __syncthreads();
        const std::uint32_t end = b + 1 < bricks ? state.bricks[b + 1].first : blocks.count;
        for (std::uint32_t cell = state.bricks[b].first + threadIdx.x; cell < end; cell += block_threads) {
            const int level = blocks.level[cell];
            if (level != 0 && draws(blocks, ClosedCell(blocks, cell), level))
                places.add_cell(closed_place_of(blocks.place[cell]), level);
        }
        __syncthreads();
        places.count();
        if (threadIdx.x == 0)
            places.first =
                atomicAdd(&state.counts->needed[static_cast<int>(Resource::lattice_blocks)], Counter{places.blocks});
        __syncthreads();
        const Counter first = places.first;
        const std::uint32_t count = places.blocks;
        const bool has_room = first + count <= state.capacity[Resource::lattice_blocks];
        std::uint32_t done[BrickTotals::count] = {};
        for (std::uint32_t begin = 0; has_room && begin < count; begin += block_threads) {
            const std::uint32_t i = begin + threadIdx.x;
            LatticeBlock block;
            KeptBlock kept;
            if (i < count) {
                const int place = places.nth(i);
                const LevelsAround around = places.around(place);
                const int level = places.level[BrickPlaces::border + static_cast<unsigned>(place)];
                block = lattice_block(blocks, brick.block(closed_coordinate(place)), place, level);
                kept = kept_block(brick, block, around);
            }
            std::uint32_t own[] = {static_cast<std::uint32_t>(popcount(kept.corners)),
                                   static_cast<std::uint32_t>(popcount(kept.middles) + popcount(kept.quarters)),
                                   static_cast<std::uint32_t>(kept.edges.count()), block.level != 0 ? 1U : 0U,
                                   static_cast<std::uint32_t>(popcount(kept.outer_faces))};
            std::uint32_t all[BrickTotals::count];
            places.sums.sum_below(own, all);
            if (i < count) {
                kept.before = {done[0] + own[0], done[1] + own[1], done[2] + own[2], done[3] + own[3],
                               done[4] + own[4]};
                state.lattice_blocks[first + i] = block;
                state.kept_blocks[first + i] = kept;
            }
            for (unsigned n = 0; n < BrickTotals::count; ++n) done[n] += all[n];
        }
        if (threadIdx.x == 0)
            state.kept_bricks[b] = {static_cast<std::uint32_t>(first),
                                    count,
                                    places.row_count(),
                                    places.levels,
                                    {done[0], done[1], done[2], done[3], done[4]}};
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
