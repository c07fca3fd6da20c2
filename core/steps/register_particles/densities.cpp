// The color field's weights: mass over density, where a particle's density is the sum of the density field at its
// place.
#include "field/cubic_spline.hpp"
#include "steps/cpu_steps.hpp"
#include "steps/register_particles/particle_batches.hpp"

namespace meniscus::cpu {

void divide_weights_by_density(ParticleSets& sets, NeighborSearch& search) {
    // A density is a sum of the weights that it will divide: all are computed before any is.
    for (unsigned k = 0; k < particle_level_count; ++k)
        sum_at_particles(sets, k, [&](const Units3& origin, const PointList& points, float* out, unsigned worker) {
            sum_points<CubicSpline>(search.near_box(origin, box_of(points), worker), points, out);
        });
    for (unsigned k = 0; k < particle_level_count; ++k) {
        ParticleSet& set = sets[k];
        sets.workers.for_ranges(set.count(), 8192, [&](std::size_t begin, std::size_t end, unsigned) {
            for (std::size_t i = begin; i < end; ++i) set.weight[i] /= set.sums[i];
        });
    }
    search.even_out();
    search.forget();
}

}  // namespace meniscus::cpu
