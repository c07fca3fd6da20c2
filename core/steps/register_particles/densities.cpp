// The color field's weights: mass over density, where a particle's density is the sum of the density field at its
// place.
#include <algorithm>

#include "engine/cpu/point_sums.hpp"
#include "steps/cpu_steps.hpp"

namespace meniscus::cpu {
namespace {

/// Of the set's particles in one of its bricks.
void measure_densities(ParticleSet& set, const Brick& brick, Neighborhoods& near, unsigned worker) {
    // The middle of the brick: float32 then holds the coordinates of all that is near it.
    const std::int64_t half = set.cell_units * brick_size / 2;
    const auto middle = static_cast<float>(half);
    const Units3 origin{(2 * brick.coordinate.x + 1) * half, (2 * brick.coordinate.y + 1) * half,
                        (2 * brick.coordinate.z + 1) * half};
    PointList points;
    alignas(32) float out[2 * Lanes::count];
    // Particles in a row of cells follow one another: they fill the lanes whatever cells they are in.
    brick.for_each_run({0, 0, 0}, {brick_size - 1, brick_size - 1, brick_size - 1},
                       [&](std::uint32_t cell, std::uint32_t count) {
                           const std::uint32_t end = set.first[cell + count];
                           for (std::uint32_t begin = set.first[cell]; begin < end; begin += 2 * Lanes::count) {
                               points.count = 0;
                               for (std::uint32_t i = begin; i < end && points.count < 2 * Lanes::count; ++i)
                                   points.add(set.x[i] - middle, set.y[i] - middle, set.z[i] - middle);
                               pad(points);
                               sum_points(near.near_box(origin, box_of(points), worker), points, out);
                               std::copy(out, out + points.count, set.densities.begin() + begin);
                           }
                       });
}

}  // namespace

void divide_weights_by_density(ParticleSets& sets, Neighborhoods& near) {
    // A density is a sum of the weights that it will divide: all are computed before any is.
    for (unsigned k = 0; k < particle_level_count; ++k) {
        ParticleSet& set = sets[k];
        resize_for_overwrite(set.densities, set.count());
        sets.workers.for_ranges(set.cells.bricks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned worker) {
            for (std::size_t b = begin; b < end; ++b) measure_densities(set, set.cells.bricks[b], near, worker);
        });
    }
    for (unsigned k = 0; k < particle_level_count; ++k) {
        ParticleSet& set = sets[k];
        sets.workers.for_ranges(set.count(), 8192, [&](std::size_t begin, std::size_t end, unsigned) {
            for (std::size_t i = begin; i < end; ++i) set.weight[i] /= set.densities[i];
        });
    }
    near.even_out();
    near.forget();
}

}  // namespace meniscus::cpu
