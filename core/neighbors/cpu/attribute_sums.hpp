// The particles' numbers at points, by whole registers: sums for their means, and the particle with the largest share.
#pragma once

#include <cstddef>

#include "field/sums.hpp"
#include "neighbors/cpu/point_sums.hpp"
#include "particles/attributes.hpp"

namespace meniscus::cpu {

/// Means of the first K numbers; not-a-numbers where the weight is 0. has_gradient: normals, too.
template <class Kernel, unsigned K, bool has_gradient>
void find_means(const NeighborLists::Levels& near, const PointList& points, const AttributeNumber* numbers,
                const NormalRows& normals, GroupValues& values) {
    for (std::size_t i = 0; i < points.count; i += WideLanes::count) {
        const WideLanes x = WideLanes::load(points.x + i), y = WideLanes::load(points.y + i),
                        z = WideLanes::load(points.z + i);
        WideLanes gx(0.0F), gy(0.0F), gz(0.0F), weight(0.0F), sum[K];
        for (WideLanes& s : sum) s = WideLanes(0.0F);
        for (const NeighborList& of_level : near)
            sum_numbers<Kernel, K, has_gradient>(of_level.view(), of_level.values(), x, y, z, gx, gy, gz, weight, sum);
        if constexpr (has_gradient) {
            turn_outward(gx, gy, gz);
            gx.store(normals.x + i);
            gy.store(normals.y + i);
            gz.store(normals.z + i);
        }
        weight.store(values.weight + i);
        for (unsigned k = 0; k < K; ++k) numbers[k].mean(sum[k], weight).store(values.of[k] + i);
    }
}

/// Ids of the particles with the largest shares.
template <class Kernel>
void find_ids(const NeighborLists::Levels& near, const PointList& points, GroupValues& values) {
    for (std::size_t i = 0; i < points.count; i += WideLanes::count) {
        const WideLanes x = WideLanes::load(points.x + i), y = WideLanes::load(points.y + i),
                        z = WideLanes::load(points.z + i);
        LargestShare largest[WideLanes::count];
        // A particle is looked at in the few lanes in which none before it has a larger share.
        constexpr float least_share = 0x1p-149F;
        WideLanes enough(least_share);
        for (const NeighborList& of_level : near) {
            const NeighborView neighbors = of_level.view();
            for (std::size_t j = 0; j < neighbors.count; ++j) {
                const WideLanes share = Kernel::of(neighbors, j)
                                            .share(x - WideLanes(neighbors.x[j]), y - WideLanes(neighbors.y[j]),
                                                   z - WideLanes(neighbors.z[j]));
                unsigned lanes = less_equal(enough, share);
                if (lanes == 0) continue;
                alignas(64) float shares[WideLanes::count];
                share.store(shares);
                for (; lanes != 0; lanes &= lanes - 1) {
                    const int lane = lowest_bit(lanes);
                    largest[lane].add(shares[lane], of_level.values() + group_size_of_numbers * j);
                }
                for (int lane = 0; lane < WideLanes::count; ++lane) shares[lane] = largest[lane].share;
                enough = max(WideLanes::load(shares), WideLanes(least_share));
            }
        }
        for (std::size_t lane = 0; lane < WideLanes::count; ++lane) {
            values.weight[i + lane] = largest[lane].share;
            for (std::size_t k = 0; k < group_size_of_numbers; ++k)
                values.of[k][i + lane] = AttributeNumber::as_float(largest[lane].ids[k]);
        }
    }
}

}  // namespace meniscus::cpu
