// Neighbors of a box, 32 at a time: the lanes of a warp look up rows of support cells side by side, and share out
// evenly what lies in them.
#pragma once

#include "engine/cuda/warp.hpp"
#include "neighbors/cuda/neighbor.hpp"
#include "particles/neighbor_bricks.hpp"

namespace meniscus::cuda {

/// The support cells near a box as rows along x, each within one brick, in the order of their particles. The box is at
/// most four base cells wide, so that at most seven support cells a side are near it, in at most two bricks a side.
class NeighborRows {
public:
    /// A row's particles, and the brick by which shift() moves them.
    struct Run {
        std::uint32_t begin = 0, end = 0;
        unsigned brick = 0;  ///< number among the eight bricks at the lowest one, for shift()
    };

    /// All lanes of a warp call it. The box, in units from the corner of a base cell, lies in the brick of base cells
    /// that `near` belongs to; base_cell: that cell's offset in it.
    __device__ NeighborRows(const ParticleSetView& set, const NeighborBricks& near, const Int3& base_cell,
                            const UnitBox& box)
        : set_(set) {
        const auto cell_units = static_cast<int>(set.cell_units);
        // Units from the corner of slot 0's brick, less than three such bricks, to cells. An estimate is off by one
        // where the quotient is nearly whole.
        const auto cell_at = [&](int at) {
            const int estimate = static_cast<int>(static_cast<float>(at) * near.cells_per_unit);
            const int rest = at - estimate * cell_units;
            return estimate + (rest >= cell_units ? 1 : 0) - (rest < 0 ? 1 : 0);
        };
        const int edge = cell_units * brick_size;
        const int cells[3] = {base_cell.x, base_cell.y, base_cell.z};
        int low[3], high[3];
        for (int axis = 0; axis < 3; ++axis) {
            // See ParticleSetView::for_each_run_near().
            const int corner = cells[axis] * units_per_base_cell - near.corner[axis];
            low[axis] = cell_at(corner + static_cast<int>(floorf(box.low[axis] - set.support)));
            high[axis] = cell_at(corner + static_cast<int>(ceilf(box.high[axis] + set.support)) - 1);
            shift_[axis] = static_cast<float>((low[axis] >> brick_axis_shift) * edge - corner);
        }
        edge_ = static_cast<float>(edge);
        low_ = {low[0], low[1], low[2]};
        size_ = {high[0] - low[0] + 1, high[1] - low[1] + 1, high[2] - low[2] + 1};
        first_ = {before_border(low_.x, size_.x), before_border(low_.y, size_.y), before_border(low_.z, size_.z)};
        const unsigned lane = lane_index();
        const Int3 step{static_cast<int>(lane & 1), static_cast<int>(lane >> 1 & 1), static_cast<int>(lane >> 2 & 1)};
        const bool is_met = lane < 8 && (step.x == 0 || first_.x < size_.x) && (step.y == 0 || first_.y < size_.y) &&
                            (step.z == 0 || first_.z < size_.z);
        brick_of_lane_ = is_met ? near.at(brick_of(low_) + step) : no_index;
    }

    __device__ unsigned count() const {
        return static_cast<unsigned>(size_.z * size_.y * (first_.x < size_.x ? 2 : 1));
    }
    /// The particles of row i, none where there is no such row; all lanes of a warp call it.
    __device__ Run run(unsigned i) const {
        Run run;
        // Bricks come one after another, z first, and in each its rows.
        int left = static_cast<int>(i);
        const auto step_over = [&](int first, int all, int rows) {
            const bool beyond = left >= first * rows;
            if (beyond) left -= first * rows;
            return beyond ? Part{1, first, all - first} : Part{0, 0, first};
        };
        const int across = first_.x < size_.x ? 2 : 1;
        const Part z = step_over(first_.z, size_.z, size_.y * across);
        const Part y = step_over(first_.y, size_.y, z.size * across);
        const int rows = z.size * y.size;
        const int x = left >= rows ? 1 : 0;
        if (x != 0) left -= rows;
        run.brick = static_cast<unsigned>((x | y.brick << 1 | z.brick << 2) & 7);
        const std::uint32_t index = __shfl_sync(all_lanes, brick_of_lane_, static_cast<int>(run.brick));
        if (i >= count() || index == no_index) return run;
        const auto slice = static_cast<int>(static_cast<unsigned>(left) / static_cast<unsigned>(y.size));
        const Brick& brick = set_.cells.bricks[index];
        const int first_cell = x != 0 ? 0 : low_.x & brick_axis_mask;
        const int cells = x != 0 ? size_.x - first_.x : first_.x;
        const int cell = first_cell |
                         ((low_.y + y.begin + left - slice * y.size) & brick_axis_mask) << brick_axis_shift |
                         ((low_.z + z.begin + slice) & brick_axis_mask) << (2 * brick_axis_shift);
        const std::uint64_t occupied = brick.occupied[cell >> 6];
        const auto members = static_cast<unsigned>(occupied >> (cell & 63)) & ((1U << cells) - 1);
        if (members == 0) return run;
        const std::uint32_t number =
            brick.first + brick.rank[cell >> 6] +
            static_cast<std::uint32_t>(popcount(occupied & ((std::uint64_t{1} << (cell & 63)) - 1)));
        run.begin = set_.first[number];
        run.end = set_.first[number + static_cast<std::uint32_t>(__popc(members))];
        return run;
    }
    /// The distance that makes coordinates of particles in a run's brick relative to the origin. A whole multiple of 16
    /// units: no sum is rounded.
    __device__ float shift(unsigned brick, int axis) const {
        return (brick >> axis & 1) != 0 ? shift_[axis] + edge_ : shift_[axis];
    }

private:
    /// The part of the rows along an axis that lies in one brick.
    struct Part {
        int brick, begin, size;
    };
    __device__ static int before_border(int low, int size) {
        const int first = brick_size - (low & brick_axis_mask);
        return first < size ? first : size;
    }

    const ParticleSetView& set_;
    Int3 low_;    ///< lowest cell, from the corner of slot 0's brick
    Int3 size_;   ///< cells a side
    Int3 first_;  ///< cells a side in the lowest brick
    std::uint32_t brick_of_lane_ = no_index;
    float edge_ = 0.0F;  ///< edge of a brick of support cells, units
    float shift_[3] = {};
};

/// The particles of up to 32 rows one after another.
template <class Kernel>
class ParticlesOfRows {
public:
    /// The particles of the rows from `first_row` on; all lanes of a warp call it.
    __device__ ParticlesOfRows(const LevelParticles<Kernel>& level, const NeighborRows& rows, unsigned first_row)
        : level_(level), rows_(rows), run_(rows.run(first_row + lane_index())) {
        below_ = sum_of_lanes_below(run_.end - run_.begin, total);
    }
    /// The i-th particle, each lane its own; all lanes of a warp call it. No particle where there are fewer.
    __device__ Neighbor neighbor(std::uint32_t i) const {
        const unsigned from = lane_with(i, below_);
        const std::uint32_t rank = __shfl_sync(all_lanes, run_.begin - below_, static_cast<int>(from)) + i;
        const unsigned brick = __shfl_sync(all_lanes, run_.brick, static_cast<int>(from));
        const float shift[3] = {rows_.shift(brick, 0), rows_.shift(brick, 1), rows_.shift(brick, 2)};
        return i < total ? level_.neighbor(rank, shift) : Neighbor{};
    }

    std::uint32_t total = 0;

private:
    const LevelParticles<Kernel>& level_;
    const NeighborRows& rows_;
    NeighborRows::Run run_;  ///< particles of this lane's row
    std::uint32_t below_ = 0;
};

/// Calls visit(Neighbor, whether there is one) in all lanes for the particles of these rows, neighboring ones in
/// neighboring lanes, in their order.
template <class Kernel, class Visit>
__device__ void for_each_particle_of_rows(const LevelParticles<Kernel>& level, const NeighborRows& rows,
                                          const Visit& visit) {
    const unsigned lane = lane_index();
    const unsigned count = rows.count();
    for (unsigned first_row = 0; first_row < count; first_row += warp_threads) {
        const ParticlesOfRows<Kernel> particles(level, rows, first_row);
        for (std::uint32_t start = 0; start < particles.total; start += warp_threads) {
            const std::uint32_t i = start + lane;
            visit(particles.neighbor(i), i < particles.total);
        }
    }
}

}  // namespace meniscus::cuda
