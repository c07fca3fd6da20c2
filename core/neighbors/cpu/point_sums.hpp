// Values of the field at lists of points, by whole registers.
#pragma once

#include <cstddef>

#include "field/sums.hpp"
#include "neighbors/cpu/field_source.hpp"
#include "neighbors/cpu/neighbor_list.hpp"
#include "particles/particle_set.hpp"

namespace meniscus::cpu {

/// The smallest box around padded points.
inline UnitBox box_of(const PointList& points) {
    UnitBox box;
    const float* coordinates[3] = {points.x, points.y, points.z};
    for (int axis = 0; axis < 3; ++axis) {
        WideLanes low = WideLanes::load(coordinates[axis]);
        WideLanes high = low;
        for (std::size_t i = WideLanes::count; i < points.count; i += WideLanes::count) {
            low = min(low, WideLanes::load(coordinates[axis] + i));
            high = max(high, WideLanes::load(coordinates[axis] + i));
        }
        box.low[axis] = reduce_min(low);
        box.high[axis] = reduce_max(high);
    }
    return box;
}

/// The same around the points of a register.
template <class F>
UnitBox box_of_lanes(F x, F y, F z) {
    return {{reduce_min(x), reduce_min(y), reduce_min(z)}, {reduce_max(x), reduce_max(y), reduce_max(z)}};
}

/// Lanes beyond the last point repeat it.
inline void pad(PointList& points) {
    for (std::size_t i = points.count; i % WideLanes::count != 0; ++i) {
        points.x[i] = points.x[points.count - 1];
        points.y[i] = points.y[points.count - 1];
        points.z[i] = points.z[points.count - 1];
    }
}

/// Calls visit.operator()<F>(i) for each register that the points fill: F are its lanes, i its first point.
template <class Visit>
void for_each_register(const PointList& points, const Visit& visit) {
    std::size_t i = 0;
    for (; points.count > i + NarrowLanes::count; i += WideLanes::count) visit.template operator()<WideLanes>(i);
    if (points.count > i) visit.template operator()<NarrowLanes>(i);
}

/// Values at G registers of points from the i-th on.
template <class Kernel, class F, int G>
void sum_group(const NeighborLists::Levels& near, const PointList& points, std::size_t i, float* out) {
    F x[G], y[G], z[G], sum[G];
    for (int g = 0; g < G; ++g) {
        const std::size_t at = i + static_cast<std::size_t>(g) * F::count;
        x[g] = F::load(points.x + at);
        y[g] = F::load(points.y + at);
        z[g] = F::load(points.z + at);
        sum[g] = F(0.0F);
    }
    for (const NeighborList& of_level : near) sum_values<Kernel, G>(of_level.view(), x, y, z, sum);
    for (int g = 0; g < G; ++g) sum[g].store(out + i + static_cast<std::size_t>(g) * F::count);
}

template <class Kernel>
void sum_points(const NeighborLists::Levels& near, const PointList& points, float* out) {
#ifdef __AVX512F__
    // One by one: operations take a particle's numbers from memory into all lanes by themselves, which is free; for two
    // registers each number would be loaded into a third, which costs more than it saves.
    for_each_register(points, [&]<class F>(std::size_t i) { sum_group<Kernel, F, 1>(near, points, i, out); });
#else
    std::size_t i = 0;
    for (; points.count > i + WideLanes::count; i += 2 * WideLanes::count)
        sum_group<Kernel, WideLanes, 2>(near, points, i, out);
    if (points.count > i) sum_group<Kernel, WideLanes, 1>(near, points, i, out);
#endif
}

}  // namespace meniscus::cpu
