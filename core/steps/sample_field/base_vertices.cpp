// Base vertices are sampled for all stored cells, before the band is known.
#include "engine/cpu/clusters.hpp"
#include "field/kernels.hpp"
#include "field/sums.hpp"
#include "steps/cpu_steps.hpp"
#include "steps/sample_field/sample_field.hpp"

namespace meniscus::cpu {
namespace {

template <class Kernel>
void sample(State& s, Neighborhoods& near) {
    resize_for_overwrite(s.reaches, s.block_count());
    s.samples.reserve(s.block_count());
    s.samples.resize(s.block_count());
    // Base vertices of a cluster fill the lanes; their cells' bounds need the same particles.
    alignas(64) float lane_x[cluster_blocks], lane_y[cluster_blocks], lane_z[cluster_blocks];
    for (int i = 0; i < cluster_blocks; ++i) {
        lane_x[i] = static_cast<float>(cluster_step(i).x) * base_edge;
        lane_y[i] = static_cast<float>(cluster_step(i).y) * base_edge;
        lane_z[i] = static_cast<float>(cluster_step(i).z) * base_edge;
    }
    s.workers.for_ranges(s.grid.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned worker) {
        const WideLanes x[1] = {WideLanes::load(lane_x)}, y[1] = {WideLanes::load(lane_y)},
                        z[1] = {WideLanes::load(lane_z)};
        const WideLanes half(base_edge / 2);
        alignas(64) float value[cluster_blocks], bound[cluster_blocks], closest[cluster_blocks];
        for (std::size_t b = begin; b < end; ++b) {
            const Brick& brick = s.grid.bricks[b];
            for_each_cluster(brick.occupied, [&](const Int3& corner) {
                const Int3 base = brick.corner() + corner;
                WideLanes sum[1] = {WideLanes(0.0F)};
                WideLanes most(0.0F), nearest(0.0F);
                for (const Candidates& c : near.near_cluster(base, worker)) {
                    sum_values<Kernel, 1>(c.view(), x, y, z, sum);
                    sum_bounds<Kernel>(c.view(), x[0] + half, y[0] + half, z[0] + half, base_edge / 2, most, nearest);
                }
                sum[0].store(value);
                most.store(bound);
                nearest.store(closest);
                for (int i = 0; i < cluster_blocks; ++i) {
                    const Int3 step = cluster_step(i);
                    const int place = index_in_brick(corner + step);
                    if (!brick.holds(place)) continue;
                    const std::uint32_t block = brick.number(place);
                    s.samples[block] = value[i];
                    s.reaches[block] = {bound[i], closest[i]};
                    s.first_sample[block] = block;
                    s.sampled[block] = 1;
                    const bool allowed =
                        !s.settings.has_domain ||
                        (domain_points(base + step, s.settings.domain_low, s.settings.domain_high) & 1) != 0;
                    s.inside[block] = allowed && value[i] > s.settings.iso ? 1 : 0;
                }
            });
        }
    });
    s.field_evaluations += s.block_count();
    near.even_out();
}

}  // namespace

void sample_base_vertices(State& s, Neighborhoods& near) {
    with_kernel(s.settings, [&]<class Kernel>() { sample<Kernel>(s, near); });
}

}  // namespace meniscus::cpu
