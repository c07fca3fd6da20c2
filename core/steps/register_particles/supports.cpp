// The smooth field's supports and weights, for all particles of a frame.
#include "steps/register_particles/supports.hpp"

#include "steps/cpu_steps.hpp"
#include "steps/register_particles/particle_batches.hpp"

namespace meniscus::cpu {
namespace {

/// Calls kernel_of(its sum, its kernel) for every particle; the result becomes its kernel.
template <class KernelOf>
void give_kernels(ParticleSets& sets, const KernelOf& kernel_of) {
    for (unsigned k = 0; k < particle_level_count; ++k) {
        ParticleSet& set = sets[k];
        sets.workers.for_ranges(set.count(), 4096, [&](std::size_t begin, std::size_t end, unsigned) {
            for (std::size_t i = begin; i < end; ++i) {
                const Poly6 kernel = kernel_of(k, set.sums[i], Poly6{set.weight[i], set.fall[i]});
                set.weight[i] = kernel.weight;
                set.fall[i] = kernel.fall;
            }
        });
    }
}

/// Counts the particles alone, and lists them where the settings want it.
void find_spray(ParticleSets& sets) {
    sets.spray.clear();
    sets.spray_particles = 0;
    for (ParticleSet& set : sets.of_level) {
        const auto is_alone = [&](std::size_t i) -> std::uint64_t {
            return is_spray(set.sums[i], sets.settings.smooth) &&
                           lies_in_own_cell(set.keys[i], set.cell_units, sets.settings.part)
                       ? 1
                       : 0;
        };
        const std::size_t before = sets.spray.size();
        if (sets.settings.lists_spray) sets.spray.resize(before + set.count());
        const std::uint64_t alone =
            sets.scan.exclusive(sets.workers, set.count(), is_alone, [&](std::size_t i, std::uint64_t at) {
                if (sets.settings.lists_spray && is_alone(i) != 0)
                    sets.spray[before + at] = spray_point(set.keys[i], set.cell_units, sets.settings.units_per_length);
            });
        if (sets.settings.lists_spray) sets.spray.resize(before + alone);
        sets.spray_particles += alone;
    }
}

}  // namespace

void fit_supports(ParticleSets& sets, NeighborSearch& search) {
    for (unsigned k = 0; k < particle_level_count; ++k) {
        resize_for_overwrite(sets[k].fall, sets[k].count() + WideLanes::count);
        std::fill(sets[k].fall.end() - WideLanes::count, sets[k].fall.end(), 0.0F);
        sum_at_particles(sets, k, [&](const Units3& origin, const PointList& points, float* out, unsigned worker) {
            sum_points<Company>(search.company_near_box(origin, box_of(points), worker), points, out);
        });
    }
    find_spray(sets);
    const SmoothField& smooth = sets.settings.smooth;
    give_kernels(sets, [&](unsigned level, float company, const Poly6&) {
        return sets.settings.leaves_out_spray && is_spray(company, smooth) ? Poly6::none()
                                                                           : fitted_kernel(company, level, smooth);
    });
    for (unsigned k = 0; k < particle_level_count; ++k)
        sum_at_particles(sets, k, [&](const Units3& origin, const PointList& points, float* out, unsigned worker) {
            sum_points<Poly6>(search.near_box(origin, box_of(points), worker), points, out);
        });
    give_kernels(sets,
                 [&](unsigned, float value, const Poly6& kernel) { return lifted_kernel(kernel, value, smooth); });
    search.even_out();
    search.forget();
}

}  // namespace meniscus::cpu
