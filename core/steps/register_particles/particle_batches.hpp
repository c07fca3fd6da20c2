// The particles of a set in batches of neighbors, for sums at their places.
#pragma once

#include <algorithm>
#include <cstdint>

#include "neighbors/cpu/particle_sets.hpp"
#include "neighbors/cpu/point_sums.hpp"

namespace meniscus::cpu {

/// Calls sum(origin, points, out) for batches of the particles of one level: their places relative to an origin, and
/// room for one number each, which becomes ParticleSet::sums.
template <class Sum>
void sum_at_particles(ParticleSets& sets, unsigned level, const Sum& sum) {
    ParticleSet& set = sets[level];
    resize_for_overwrite(set.sums, set.count());
    const auto sum_in_brick = [&](const Brick& brick, unsigned worker) {
        // The middle of the brick: float32 then holds the coordinates of all that is near it.
        const std::int64_t half = set.cell_units * brick_size / 2;
        const auto middle = static_cast<float>(half);
        const Units3 origin{(2 * brick.coordinate.x + 1) * half, (2 * brick.coordinate.y + 1) * half,
                            (2 * brick.coordinate.z + 1) * half};
        PointList points;
        alignas(64) float out[2 * WideLanes::count];
        // Particles in a row of cells follow one another: they fill the lanes whatever cells they are in.
        const auto sum_in_row = [&](std::uint32_t cell, std::uint32_t count) {
            const std::uint32_t end = set.first[cell + count];
            for (std::uint32_t begin = set.first[cell]; begin < end; begin += 2 * WideLanes::count) {
                points.count = 0;
                for (std::uint32_t i = begin; i < end && points.count < 2 * WideLanes::count; ++i)
                    points.add(set.x[i] - middle, set.y[i] - middle, set.z[i] - middle);
                pad(points);
                sum(origin, points, out, worker);
                std::copy(out, out + points.count, set.sums.begin() + begin);
            }
        };
        brick.for_each_run({0, 0, 0}, {brick_size - 1, brick_size - 1, brick_size - 1}, sum_in_row);
    };
    sets.workers.for_ranges(set.cells.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned worker) {
        for (std::size_t b = begin; b < end; ++b) sum_in_brick(set.cells.bricks[b], worker);
    });
}

}  // namespace meniscus::cpu
