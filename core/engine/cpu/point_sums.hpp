// Values of the field at lists of points, by whole registers.
#pragma once

#include <cstddef>

#include "engine/cpu/candidates.hpp"
#include "engine/cpu/field_source.hpp"
#include "field/sums.hpp"
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

/// Lanes beyond the last point repeat it.
inline void pad(PointList& points) {
    for (std::size_t i = points.count; i % WideLanes::count != 0; ++i) {
        points.x[i] = points.x[points.count - 1];
        points.y[i] = points.y[points.count - 1];
        points.z[i] = points.z[points.count - 1];
    }
}

/// Values at G registers of points from the i-th on.
template <class Kernel, int G>
void sum_group(const CandidateLists::Levels& near, const PointList& points, std::size_t i, float* out) {
    WideLanes x[G], y[G], z[G], sum[G];
    for (int g = 0; g < G; ++g) {
        const std::size_t at = i + static_cast<std::size_t>(g) * WideLanes::count;
        x[g] = WideLanes::load(points.x + at);
        y[g] = WideLanes::load(points.y + at);
        z[g] = WideLanes::load(points.z + at);
        sum[g] = WideLanes(0.0F);
    }
    for (const Candidates& c : near) sum_values<Kernel, G>(c.view(), x, y, z, sum);
    for (int g = 0; g < G; ++g) sum[g].store(out + i + static_cast<std::size_t>(g) * WideLanes::count);
}

template <class Kernel>
void sum_points(const CandidateLists::Levels& near, const PointList& points, float* out) {
    std::size_t i = 0;
    for (; points.count > i + WideLanes::count; i += 2 * WideLanes::count) sum_group<Kernel, 2>(near, points, i, out);
    if (points.count > i) sum_group<Kernel, 1>(near, points, i, out);
}

}  // namespace meniscus::cpu
