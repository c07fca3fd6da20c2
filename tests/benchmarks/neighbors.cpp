#include "neighbors.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "field/smooth_field.hpp"
#include "steps/register_particles/supports.hpp"

namespace meniscus::benchmarks {
namespace {

std::int64_t cell_of(double coordinate, double edge) {
    return static_cast<std::int64_t>(std::floor(coordinate / edge));
}

/// The key of the cell (x, y, z), each within 2^20 of the origin.
std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
    constexpr std::int64_t half = 1 << 20;
    return static_cast<std::uint64_t>(x + half) << 42U | static_cast<std::uint64_t>(y + half) << 21U |
           static_cast<std::uint64_t>(z + half);
}

std::uint64_t key_at(const float* point, double edge) {
    return key(cell_of(point[0], edge), cell_of(point[1], edge), cell_of(point[2], edge));
}

}  // namespace

std::vector<std::size_t> pick_evenly(std::size_t n, std::size_t limit) {
    const std::size_t count = std::min(n, limit);
    std::vector<std::size_t> picked(count);
    for (std::size_t i = 0; i < count; ++i) picked[i] = i * n / count;
    return picked;
}

ParticlesNear::ParticlesNear(std::span<const float> particles, const Settings& settings)
    : particles_(particles),
      is_smooth_(settings.field == Field::smooth),
      smoothness_(is_smooth_ ? smoothness(settings) : 0),
      radius_(settings.particle_radius),
      widest_(support(settings) * settings.particle_radius),
      order_(particles.size() / 3) {
    std::iota(order_.begin(), order_.end(), 0U);
    std::vector<std::uint64_t> keys(order_.size());
    for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = key_at(&particles_[3 * i], widest_);
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
    for (std::size_t i = 0; i < order_.size(); ++i) first_.try_emplace(keys[order_[i]], i);
}

template <class Visit>
void ParticlesNear::for_each_within(const float* point, double distance, const Visit& visit) const {
    for (std::int64_t dz = -1; dz <= 1; ++dz)
        for (std::int64_t dy = -1; dy <= 1; ++dy)
            for (std::int64_t dx = -1; dx <= 1; ++dx) {
                const std::uint64_t cell = key(cell_of(point[0], widest_) + dx, cell_of(point[1], widest_) + dy,
                                               cell_of(point[2], widest_) + dz);
                const auto found = first_.find(cell);
                if (found == first_.end()) continue;
                for (std::size_t i = found->second; i < order_.size(); ++i) {
                    const float* const p = &particles_[3 * std::size_t{order_[i]}];
                    if (key_at(p, widest_) != cell) break;
                    const double x = p[0] - point[0], y = p[1] - point[1], z = p[2] - point[2];
                    const double squared = x * x + y * y + z * z;
                    if (squared < distance * distance) visit(order_[i], squared);
                }
            }
}

double ParticlesNear::company_support() const {
    return radius_ * static_cast<double>(SmoothField(smoothness_).company_support);
}

double ParticlesNear::support_of(std::uint32_t particle) {
    if (!is_smooth_) return widest_;
    const auto [found, is_new] = supports_.try_emplace(particle, 0.0);
    if (is_new) {
        const double reach = company_support();
        double company = 0.0;
        for_each_within(&particles_[3 * std::size_t{particle}], reach, [&](std::uint32_t, double squared) {
            company += std::pow(1.0 - squared / (reach * reach), 3.0);
        });
        const SmoothField field(smoothness_);
        found->second = radius_ * static_cast<double>(fitted_kernel(static_cast<float>(company), 0, field).support() /
                                                      field.units_per_radius[0]);
    }
    return found->second;
}

std::size_t ParticlesNear::reaching(const float* point) {
    std::size_t count = 0;
    for_each_within(point, widest_, [&](std::uint32_t particle, double squared) {
        const double reach = support_of(particle);
        if (squared < reach * reach) ++count;
    });
    return count;
}

std::size_t ParticlesNear::summed_at_particle(std::size_t particle) {
    const float* const place = &particles_[3 * particle];
    std::size_t count = reaching(place);
    if (is_smooth_) for_each_within(place, company_support(), [&](std::uint32_t, double) { ++count; });
    return count;
}

}  // namespace meniscus::benchmarks
