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
    // Base vertices of 2 x 2 x 2 cells fill the lanes; their cells' bounds need the same particles.
    alignas(32) float lane_x[8], lane_y[8], lane_z[8];
    for (int i = 0; i < 8; ++i) {
        lane_x[i] = static_cast<float>(i & 1) * base_edge;
        lane_y[i] = static_cast<float>(i >> 1 & 1) * base_edge;
        lane_z[i] = static_cast<float>(i >> 2) * base_edge;
    }
    s.workers.for_ranges(s.grid.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned worker) {
        const Lanes<8> x[1] = {Lanes<8>::load(lane_x)}, y[1] = {Lanes<8>::load(lane_y)},
                       z[1] = {Lanes<8>::load(lane_z)};
        const Lanes<8> half(base_edge / 2);
        alignas(32) float value[8], bound[8], closest[8];
        for (std::size_t b = begin; b < end; ++b) {
            const Brick& brick = s.grid.bricks[b];
            for_each_cluster(brick.occupied, [&](const Int3& corner) {
                const Int3 base = brick.corner() + corner;
                Lanes<8> sum[1] = {Lanes<8>(0.0F)};
                Lanes<8> most(0.0F), nearest(0.0F);
                for (const Candidates& c : near.near_cluster(base, worker)) {
                    sum_values<Kernel, 1>(c.view(), x, y, z, sum);
                    sum_bounds<Kernel>(c.view(), x[0] + half, y[0] + half, z[0] + half, base_edge / 2, most, nearest);
                }
                sum[0].store(value);
                most.store(bound);
                nearest.store(closest);
                for (int i = 0; i < 8; ++i) {
                    const Int3 step{i & 1, i >> 1 & 1, i >> 2};
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
