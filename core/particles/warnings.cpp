// The thresholds are explained in core/README.md#warnings.
#include "particles/warnings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "meniscus/number_text.hpp"
#include "particles/positions.hpp"
#include "particles/spacing.hpp"

namespace meniscus {
namespace {

/// Radii. Of the drops of lone particles all are shown up to it, some are missed by larger cells.
constexpr double largest_cell = 1.5;

std::string shown(double value) {
    return rounded_text(value, 6);
}

std::string particles_text(std::size_t count) {
    return count == 1 ? "the one particle" : "all " + std::to_string(count) + " particles";
}

std::optional<Warning> wrong_radius(const ParticleFrame& frame, const Settings& settings) {
    const double radius = settings.particle_radius;
    const std::optional<FittingRadius> fitting = radius_that_fits(frame, radius);
    if (!fitting) return std::nullopt;
    const bool small = radius < fitting->radius;
    Warning warning{small ? WarningCode::radius_too_small : WarningCode::radius_too_large, radius, fitting->radius, {}};
    if (fitting->alone == 0.0) {
        warning.text = "the particle radius " + shown(radius) + " is too " + (small ? "small" : "large") +
                       " for the spacing of the particles: about " + shown(fitting->radius) + " fits";
        return warning;
    }
    // Their owner knows of them.
    if (settings.spray != Spray::keep) return std::nullopt;
    warning.text = "at the particle radius " + shown(radius) + " about " + shown(std::floor(100.0 * fitting->alone)) +
                   " % of the particles touch no other, and hardly any lies among others: about " +
                   shown(fitting->radius) + " would join them";
    return warning;
}

/// Where it does not suffice to blame the threshold.
std::size_t particles_in(const Box& domain, const ParticleFrame& frame) {
    const auto coordinate = [&](std::size_t i, std::size_t axis) {
        const Box& box = frame.quantization_box;
        return frame.is_quantized() ? decoded(frame.quantized[3 * i + axis], box.min[axis], box.max[axis])
                                    : static_cast<double>(frame.positions[3 * i + axis]);
    };
    std::size_t inside = 0;
    for (std::size_t i = 0; i < frame.count(); ++i) {
        bool is_inside = true;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double x = coordinate(i, axis);
            is_inside = is_inside && x >= domain.min[axis] && x <= domain.max[axis];
        }
        if (is_inside) ++inside;
    }
    return inside;
}

Warning empty_surface(const PlacedFrame& particles, const Settings& settings, double greatest,
                      std::uint64_t spray_particles) {
    const ParticleFrame& frame = particles.frame;
    Warning warning{WarningCode::empty_surface, greatest, settings.iso, {}};
    if (settings.spray != Spray::keep && spray_particles == frame.count())
        warning.text = "the surface is empty: " + particles_text(frame.count()) +
                       (frame.count() == 1 ? " lies alone and is" : " lie alone and are") +
                       " left out as spray; keep spray, or take a larger particle radius";
    else if (settings.domain && !particles.on_device && particles_in(*settings.domain, frame) == 0)
        warning.text = "the surface is empty: of " + particles_text(frame.count()) + " none lies in the domain";
    else
        warning.text = "the surface is empty: the greatest value of the field that was sampled is " + shown(greatest) +
                       ", and the surface lies at " + shown(settings.iso) + "; take a lower iso value or smaller cells";
    return warning;
}

/// The radius of the finest particles, of which there are some.
double finest_radius(const ParticlesByLevel& particles, const Settings& settings) {
    const auto finest =
        std::find_if(particles.begin(), particles.end(), [](std::uint64_t count) { return count != 0; });
    return std::ldexp(settings.particle_radius, static_cast<int>(finest - particles.begin()));
}

std::optional<Warning> too_large_cells(const ParticlesByLevel& particles, const Settings& settings) {
    const double cell = world_cell_size(settings);
    const double largest = largest_cell * finest_radius(particles, settings);
    if (!(cell > largest)) return std::nullopt;
    return Warning{WarningCode::cell_size_too_large, cell, largest,
                   "finest cells of " + shown(cell) + " are too large to show single particles: at most " +
                       shown(largest) + " shows them, a cell size of " + shown(largest / settings.particle_radius) +
                       " radii"};
}

/// Monaghan's spline over its value at 0. q: distance over support.
double spline(double q) {
    const double a = std::max(1.0 - q, 0.0);
    const double b = std::max(0.5 - q, 0.0);
    return 2.0 * a * a * a - 8.0 * b * b * b;
}

/// The field where it is least in water at rest: in the middle of eight particles of a cubic lattice two radii apart.
/// support: radii, up to 4.
double least_value_at_rest(Field field, double support) {
    double middle = 0.0;
    double place = 0.0;
    // Sums over a cubic lattice of particles, at one of them and in the middle of eight, as far as the support reaches.
    for (int x = -3; x <= 3; ++x)
        for (int y = -3; y <= 3; ++y)
            for (int z = -3; z <= 3; ++z) {
                place += spline(2.0 * std::sqrt(static_cast<double>(x * x + y * y + z * z)) / support);
                const double dx = 2.0 * x + 1.0, dy = 2.0 * y + 1.0, dz = 2.0 * z + 1.0;
                middle += spline(std::sqrt(dx * dx + dy * dy + dz * dz) / support);
            }
    // The particle's mass over its density; or over that at rest, (2 r)^3, where the kernel is 8 / (pi h^3) at 0.
    return field == Field::color ? middle / place : middle * 64.0 / (std::numbers::pi * support * support * support);
}

/// Radii; none where the threshold is above the field inside of water at any.
std::optional<double> smallest_joining_support(Field field, double iso) {
    double low = std::numbers::sqrt3;  // reaches nothing there
    double high = 4.0;                 // the default
    if (least_value_at_rest(field, high) <= iso) return std::nullopt;
    for (int i = 0; i < 30; ++i) {
        const double middle = (low + high) / 2.0;
        (least_value_at_rest(field, middle) <= iso ? low : high) = middle;
    }
    return std::ceil(high * 50.0) / 50.0;  // a smoothing length of two decimals, which suffices as it is written
}

std::optional<Warning> too_small_support(const Settings& settings) {
    if (settings.field == Field::smooth || support(settings) >= 4.0) return std::nullopt;
    const std::optional<double> smallest = smallest_joining_support(settings.field, settings.iso);
    constexpr double rounding = 1.0 - 1e-9;  // for a user who converts the limit from world units back to radii
    if (!smallest || support(settings) >= rounding * *smallest) return std::nullopt;
    const double value = support(settings) * settings.particle_radius;
    const double limit = *smallest * settings.particle_radius;
    return Warning{WarningCode::support_too_small, value, limit,
                   "the kernel's support of " + shown(value) + " is too small to join the particles: at least " +
                       shown(limit) + " does, a smoothing length of " + shown(*smallest / 2.0) + " radii"};
}

}  // namespace

std::optional<Warning> find_wrong_radius(const PlacedFrame& particles, const Settings& settings) {
    if (particles.on_device || particles.frame.count() == 0) return std::nullopt;
    return wrong_radius(particles.frame, settings);
}

void find_warnings(const PlacedFrame& particles, const ParticlesByLevel& by_level, const Settings& settings,
                   std::optional<Warning> wrong_radius, const std::function<float()>& greatest_sample,
                   Statistics& statistics) {
    statistics.warnings.clear();
    if (particles.frame.count() == 0) return;
    const auto add = [&](std::optional<Warning> warning) {
        if (warning) statistics.warnings.push_back(std::move(*warning));
    };
    add(std::move(wrong_radius));
    if (statistics.triangles == 0)
        add(empty_surface(particles, settings, static_cast<double>(greatest_sample()), statistics.spray_particles));
    add(too_large_cells(by_level, settings));
    add(too_small_support(settings));
}

std::string fitting_radius_hint(const PlacedFrame& particles, const Settings& settings) {
    if (particles.on_device) return {};
    const std::optional<FittingRadius> fitting = radius_that_fits(particles.frame, settings.particle_radius);
    return fitting ? " A particle radius of about " + shown(fitting->radius) + " fits their spacing" : "";
}

}  // namespace meniscus
