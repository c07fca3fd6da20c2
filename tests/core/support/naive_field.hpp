// The field by its definition: sums over all particles in double precision.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "field/lattice_settings.hpp"
#include "support/particles.hpp"

namespace meniscus::test {

inline double spline(double distance, double h) {
    const double q = distance / h;
    const double a = std::max(1 - q, 0.0), b = std::max(0.5 - q, 0.0);
    return 8 / (std::numbers::pi * h * h * h) * (2 * a * a * a - 8 * b * b * b);
}

/// 1 at distance 0.
inline double poly6(double distance, double h) {
    return std::pow(std::max(1 - distance * distance / (h * h), 0.0), 3);
}

/// Borrows the particles.
class NaiveField {
public:
    NaiveField(const Settings& s, const Particles& particles) : settings_(s), particles_(particles) {
        if (s.field == Field::smooth) {
            fit_supports();
            return;
        }
        for (std::size_t i = 0; i < particles.count(); ++i) {
            weights_.push_back(std::pow(2 * radius(i), 3));
            supports_.push_back(support(s) * radius(i));
        }
        if (s.field == Field::density) return;
        const std::vector<double> densities = values_at_particles();
        for (std::size_t i = 0; i < weights_.size(); ++i) weights_[i] /= densities[i];
    }
    double value(double x, double y, double z) const {
        double sum = 0;
        for (std::size_t i = 0; i < weights_.size(); ++i) sum += share(i, x, y, z);
        return sum;
    }
    /// The share of a particle in the value.
    double share(std::size_t i, double x, double y, double z) const {
        const auto p = position(i);
        const double distance = std::hypot(x - p[0], y - p[1], z - p[2]);
        return weights_[i] *
               (settings_.field == Field::smooth ? poly6(distance, supports_[i]) : spline(distance, supports_[i]));
    }

private:
    std::vector<double> values_at_particles() const {
        std::vector<double> values;
        for (std::size_t i = 0; i < weights_.size(); ++i) {
            const auto p = position(i);
            values.push_back(value(p[0], p[1], p[2]));
        }
        return values;
    }
    void fit_supports() {
        const SmoothField f = LatticeSettings(settings_).smooth;
        for (std::size_t i = 0; i < particles_.count(); ++i) {
            weights_.push_back(1.0);
            supports_.push_back(double{f.company_support} * radius(i));
        }
        const std::vector<double> company = values_at_particles();
        for (std::size_t i = 0; i < weights_.size(); ++i) {
            const double u =
                std::clamp((company[i] - 1 - f.least_company) / (f.full_company - f.least_company), 0.0, 1.0);
            const double t = u * u * (3 - 2 * u);
            const double h = f.lone_support + t * (f.widest_support - f.lone_support);
            weights_[i] = (t * std::pow(f.company_support, 3) / company[i] +
                           (1 - t) * std::pow(f.lone_support, 3) / (1 + f.shared_drop * (company[i] - 1))) /
                          std::pow(h, 3);
            supports_[i] = h * radius(i);
        }
        const std::vector<double> values = values_at_particles();
        for (std::size_t i = 0; i < weights_.size(); ++i) {
            const double neighbors = values[i] / weights_[i];
            const double near = std::pow(f.company_support / f.widest_support, 3) / weights_[i];
            const double least = f.least_value + f.group_lift * std::max(neighbors - f.group_size, 0.0) *
                                                     std::max(near - f.group_spread * neighbors, 0.0);
            weights_[i] *= std::max(1.0, least / values[i]);
        }
    }

private:
    double radius(std::size_t i) const {
        return settings_.particle_radius * (particles_.levels.empty() ? 1 : 1 << particles_.levels[i]);
    }
    /// Snapped as the lattice has it.
    std::array<double, 3> position(std::size_t i) const {
        const double unit = world_cell_size(settings_) / 4096;
        return {std::nearbyint(particles_.positions[3 * i] / unit) * unit,
                std::nearbyint(particles_.positions[3 * i + 1] / unit) * unit,
                std::nearbyint(particles_.positions[3 * i + 2] / unit) * unit};
    }
    Settings settings_;
    const Particles& particles_;
    std::vector<double> weights_, supports_;
};

}  // namespace meniscus::test
