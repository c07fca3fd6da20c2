// The base cells that the particles reach, on the GPU: a thread for every particle or a few, marks in the bricks
// themselves.
#include <algorithm>
#include <cmath>

#include "engine/cuda/block_counter.hpp"
#include "engine/cuda/long_loop.hpp"
#include "engine/cuda/sharing_lanes.hpp"
#include "engine/cuda/sort_key.hpp"
#include "engine/cuda/warp.hpp"
#include "steps/cuda_steps.hpp"
#include "steps/register_particles/count_by_warp.hpp"
#include "steps/register_particles/register_particles.hpp"

namespace meniscus::cuda {
namespace {

constexpr std::int64_t reached_brick_edge = std::int64_t{units_per_base_cell} * brick_size;

/// The words of a brick, which other threads mark meanwhile. A thread that reads too early marks once more than needed.
struct Marks {
    std::uint64_t* words;
    __device__ std::uint64_t word(int w) const { return *const_cast<volatile std::uint64_t*>(words + w); }
    __device__ void add(int w, std::uint64_t cells) const {
        atomicOr(reinterpret_cast<Counter*>(words + w), Counter{cells});
    }
};

/// The rows from `first` to `last`, some of the four of a word, as bits.
__device__ std::uint64_t rows_of_word(int first, int last) {
    return (last < 3 ? std::uint64_t{1} << brick_size * (last + 1) : 0) - (std::uint64_t{1} << brick_size * first);
}

/// Marks the base cells of a brick that a particle reaches, in every count-th slice from the own-th on.
template <unsigned count>
__device__ void mark_in_brick(const Marks& marks, const ReachedBox& box, float x, float y, float z, float reach,
                              unsigned own) {
    const std::uint64_t widest = row_bits(box.low[0], box.high[0]) * first_of_rows;
    for (int cz = box.low[2] + static_cast<int>(own); cz <= box.high[2]; cz += count) {
        const float gap_z = gap_to_cells(z, static_cast<float>(cz));
        for (int rows = box.low[1] & ~3; rows <= box.high[1]; rows += 4) {
            const int w = rows >> 2 | cz << 2;
            const int first = std::max(box.low[1] - rows, 0);
            const int last = std::min(box.high[1] - rows, 3);
            // Most particles lie among others, which have marked all this.
            const std::uint64_t unmarked = widest & rows_of_word(first, last) & ~marks.word(w);
            if (unmarked == 0) continue;
            std::uint64_t reached = 0;
            for (int i = first; i <= last; ++i) {
                const ReachedRows<float> cells(x, gap_to_cells(y, static_cast<float>(rows + i)), gap_z, reach);
                if (cells.set != 0)
                    reached |= row_bits(static_cast<int>(cells.first), static_cast<int>(cells.last)) << brick_size * i;
            }
            reached &= unmarked;
            if (reached != 0) marks.add(w, reached);
        }
    }
}

/// Along one axis: the places of a particle and its support cell, and the bricks of base cells that it may reach.
struct ReachAlongAxis {
    std::int64_t corner;  ///< corner of the brick of support cells, units
    std::int32_t cell;    ///< place of the support cell from that corner, cells
    float place;          ///< place of the particle from that corner, units
    std::int32_t first, last;

    __device__ ReachAlongAxis(std::int32_t brick, std::int32_t cell_in_brick, std::int64_t cell_units, float p,
                              float support)
        : corner(brick * (cell_units * brick_size)),
          cell(static_cast<std::int32_t>(cell_in_brick * cell_units)),
          place(p) {
        // No less than what ReachedBox adds to the support.
        const std::int64_t reach = static_cast<std::int64_t>(support) + 34;
        const std::int64_t at = corner + static_cast<std::int64_t>(p);
        first = static_cast<std::int32_t>((at - reach) >> reached_brick_shift);
        last = static_cast<std::int32_t>((at + reach) >> reached_brick_shift);
    }
    /// The shift to places relative to a brick of base cells.
    __device__ std::int32_t shift(std::int32_t brick) const {
        return static_cast<std::int32_t>(corner - (std::int64_t{brick} << reached_brick_shift));
    }
    /// Whether ParticleSetView::for_each_run_near() finds the support cell near the brick.
    __device__ bool is_near(std::int32_t brick, std::int64_t cell_units, float widest_support) const {
        constexpr auto size = static_cast<float>(std::int64_t{1} << reached_brick_shift);
        const std::int64_t low = shift(brick) + cell;
        return low + cell_units > static_cast<std::int64_t>(floorf(0.0F - widest_support)) &&
               low < static_cast<std::int64_t>(ceilf(size + widest_support));
    }

private:
    static constexpr int reached_brick_shift = 18;
    static_assert(std::int64_t{1} << reached_brick_shift == reached_brick_edge);
};

/// Marks the cells that each particle reaches, by `count` lanes, which share its slices. Also adds up
/// ReachedBox::count(): for the frame, or where cells will be left out, for each brick in members_before.
template <unsigned count>
__global__ void __launch_bounds__(block_threads, 3) mark_reached_cells(const __grid_constant__ State state) {
    __shared__ BlockCounter counter;
    const std::uint32_t n = state.particle_count();
    const BrickGridView grid = state.grid();
    LongLoop loop(state);
    Counter pairs = 0;
    const GridLoop threads;
    const SharingLanes<count> lanes;
    for (std::uint64_t i = threads.first / count; i < n; i += threads.step / count) {
        if (!loop.goes_on()) break;
        const unsigned level = key_level(state.keys[i]);
        const std::uint64_t cell_key = particle_key(state.keys[i]).cell;
        const std::int64_t cell_units = state.settings.cell_units[level];
        const float widest_support = state.settings.support[level];
        const float4 p = state.particles[i];
        const float support = state.settings.has_own_supports ? Poly6{p.w, state.falls[i]}.support() : widest_support;
        const float reach = support + 16.0F;
        const Int3 brick = key_brick(cell_key);
        const Int3 cell = place_in_brick(key_index(cell_key));
        const ReachAlongAxis x(brick.x, cell.x, cell_units, p.x, support);
        const ReachAlongAxis y(brick.y, cell.y, cell_units, p.y, support);
        const ReachAlongAxis z(brick.z, cell.z, cell_units, p.z, support);
        Int3 b;
        for (b.z = z.first; b.z <= z.last; ++b.z)
            for (b.y = y.first; b.y <= y.last; ++b.y)
                for (b.x = x.first; b.x <= x.last; ++b.x) {
                    const float at[3] = {x.place + static_cast<float>(x.shift(b.x)),
                                         y.place + static_cast<float>(y.shift(b.y)),
                                         z.place + static_cast<float>(z.shift(b.z))};
                    const ReachedBox box(at, reach);
                    if (box.empty() || !x.is_near(b.x, cell_units, widest_support) ||
                        !y.is_near(b.y, cell_units, widest_support) || !z.is_near(b.z, cell_units, widest_support))
                        continue;
                    const std::uint32_t number = grid.find(b);
                    if (number == no_index) continue;  // in a frame that another block has stopped
                    mark_in_brick<count>({state.bricks[number].occupied}, box, at[0], at[1], at[2], reach, lanes.own);
                    if (lanes.own != 0) continue;
                    if (state.settings.leaves_cells_out())
                        atomicAdd(reinterpret_cast<Counter*>(&state.members_before[number]), Counter{box.count()});
                    else
                        pairs += box.count();
                }
    }
    counter.add(&state.counts->pairs, pairs);
}

/// One warp for every brick: leaves out what lies beyond the domain and the part, and counts the members.
__global__ void __launch_bounds__(block_threads) count_members(const __grid_constant__ State state) {
    each_by_warp(state.count(Resource::bricks), [&](std::uint32_t b) {
        Brick& brick = state.bricks[b];
        if (state.settings.leaves_cells_out())
            for (int w = static_cast<int>(lane_index()); w < Brick::words; w += warp_threads)
                if (brick.occupied[w] != 0) brick.occupied[w] &= storable_word(state.settings, brick.coordinate, w);
        const std::uint32_t members = count_by_warp(brick);
        if (lane_index() != 0) return;
        if (state.settings.leaves_cells_out())
            atomicAdd(&state.counts->pairs, Counter{pairs_in_brick(state.members_before[b], members, true)});
        state.members_before[b] = members;
    });
}

}  // namespace

void store_reached_cells(const State& state, const Launcher& launch) {
    launch_for_particles(state, launch, mark_reached_cells<lanes_to_share>, mark_reached_cells<1>);
    launch(state.capacity[Resource::bricks], block_warps, count_members, state);
}

}  // namespace meniscus::cuda
