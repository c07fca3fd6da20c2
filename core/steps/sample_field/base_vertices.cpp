// Base vertices are sampled for all stored cells, before the band is known.
#include <limits>

#include "field/kernels.hpp"
#include "field/sums.hpp"
#include "neighbors/cpu/clusters.hpp"
#include "steps/cpu_steps.hpp"
#include "steps/sample_field/sample_field.hpp"

namespace meniscus::cpu {
namespace {

/// Some blocks of a cluster, lane by lane: their base vertices fill the lanes, and their cells' bounds need the same
/// particles.
class BaseVertices {
public:
    int count() const { return count_; }
    std::uint32_t block(int i) const { return block_[i]; }
    /// The i-th block's place in the cluster.
    const Int3& step(int i) const { return step_[i]; }

    void add(std::uint32_t block, const Int3& step) {
        block_[count_] = block;
        step_[count_] = step;
        x_[count_] = static_cast<float>(step.x) * base_edge;
        y_[count_] = static_cast<float>(step.y) * base_edge;
        z_[count_] = static_cast<float>(step.z) * base_edge;
        ++count_;
    }

    // By a register of lanes F, enough for all blocks; results of lanes beyond the last block are not used. near: the
    // neighbors of the cluster.

    template <class Kernel, class F>
    void find_values(const NeighborLists::Levels& near, float* values) const {
        const F x[1] = {F::load(x_)}, y[1] = {F::load(y_)}, z[1] = {F::load(z_)};
        F sum[1] = {F(0.0F)};
        for (const NeighborList& of_level : near) sum_values<Kernel, 1>(of_level.view(), x, y, z, sum);
        sum[0].store(values);
    }

    template <class Kernel, class F>
    void find_reaches(const NeighborLists::Levels& near, Array<CellReach>& reaches) const {
        const F half(base_edge / 2);
        const F x = F::load(x_) + half, y = F::load(y_) + half, z = F::load(z_) + half;
        F most(0.0F), nearest(0.0F);
        for (const NeighborList& of_level : near)
            sum_bounds<Kernel>(of_level.view(), x, y, z, base_edge / 2, most, nearest);
        alignas(64) float bound[cluster_blocks], closest[cluster_blocks];
        most.store(bound);
        nearest.store(closest);
        for (int i = 0; i < count_; ++i) reaches[block_[i]] = {bound[i], closest[i]};
    }

private:
    alignas(64) float x_[cluster_blocks] = {}, y_[cluster_blocks] = {}, z_[cluster_blocks] = {};
    std::uint32_t block_[cluster_blocks];
    Int3 step_[cluster_blocks];
    int count_ = 0;
};

template <class Kernel>
void sample(State& state, NeighborSearch& search) {
    resize_for_overwrite(state.reaches, state.block_count());
    state.samples.reserve(state.block_count());
    state.samples.resize(state.block_count());
    state.workers.for_ranges(state.grid.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned worker) {
        alignas(64) float value[cluster_blocks];
        for (std::size_t b = begin; b < end; ++b) {
            const Brick& brick = state.grid.bricks[b];
            for_each_cluster(brick.occupied, [&](const Int3& corner) {
                const Int3 base = brick.corner() + corner;
                const NeighborLists::Levels& list = search.near_cluster(base, worker);
                BaseVertices stored, outside;
                for (int i = 0; i < cluster_blocks; ++i) {
                    const int place = index_in_brick(corner + cluster_step(i));
                    if (brick.holds(place)) stored.add(brick.number(place), cluster_step(i));
                }
                with_lanes_for(stored.count(), [&]<class F>() { stored.find_values<Kernel, F>(list, value); });
                for (int i = 0; i < stored.count(); ++i) {
                    const std::uint32_t block = stored.block(i);
                    const Int3 step = stored.step(i);
                    const bool allowed =
                        !state.settings.has_domain ||
                        (domain_points(base + step, state.settings.domain_low, state.settings.domain_high) & 1) != 0;
                    const bool is_inside = allowed && value[i] > state.settings.iso;
                    state.samples[block] = value[i];
                    state.first_sample[block] = block;
                    state.sampled[block] = 1;
                    state.inside[block] = is_inside ? 1 : 0;
                    // The reach of particles into a cell with a corner inside does not matter.
                    if (is_inside)
                        state.reaches[block] = {std::numeric_limits<float>::infinity(), 1.0F};
                    else
                        outside.add(block, step);
                }
                if (outside.count() == 0) return;
                with_lanes_for(outside.count(),
                               [&]<class F>() { outside.find_reaches<Kernel, F>(list, state.reaches); });
            });
        }
    });
    state.field_evaluations += state.block_count();
    search.even_out();
}

}  // namespace

void sample_base_vertices(State& state, NeighborSearch& search) {
    with_kernel(state.settings, [&]<class Kernel>() { sample<Kernel>(state, search); });
}

}  // namespace meniscus::cpu
