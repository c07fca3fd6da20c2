// Constants of the criterion and of the band are explained in core/README.md#constants.
#include "field/lattice_settings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "field/cubic_spline.hpp"
#include "field/poly6.hpp"

namespace meniscus {
namespace {

/// Cells of a domain's corner; a domain beyond the lattice ends with it.
std::int32_t to_cell(double cells) {
    constexpr double limit = static_cast<double>(max_base_cell) * base_cell_size;
    return static_cast<std::int32_t>(std::clamp(cells, -limit, limit));
}

/// The distance, in supports, at which the kernel has fallen to this share of its largest value.
double lone_particle_reach(double share) {
    double low = 0.0;
    double high = 1.0;
    for (int i = 0; i < 50; ++i) {
        const double q = (low + high) / 2.0;
        const double a = 1.0 - q;
        const double b = std::max(0.5 - q, 0.0);
        (2.0 * a * a * a - 8.0 * b * b * b > share ? low : high) = q;
    }
    return low;
}

/// The level that shows a lone particle's blob. Lengths in radii; reach: the support, less for a smaller blob.
/// Measured: core/README.md#drops-025-and-017.
int blob_level(double cell_size, double reach) {
    return cell_size > 0.17 * reach ? 3 : 2;
}

/// Measured: core/README.md#the-smooth-field.
void use_smooth_field(LatticeSettings& settings, const Settings& s) {
    settings.has_own_supports = true;
    settings.leaves_out_spray = s.spray != Spray::keep;
    settings.lists_spray = s.spray == Spray::points;
    SmoothField& f = settings.smooth = SmoothField(smoothness(s), s.cell_size);
    for (unsigned k = 0; k < particle_level_count; ++k)
        settings.company_support[k] = f.company_support * f.units_per_radius[k];
    // The constants are those for the threshold 0.6. The lift follows a lower one. With a higher one it goes to 1, the
    // field at a particle alone: every particle stays above a threshold below 1, by less the higher it is.
    constexpr double usual = 0.6;
    const auto scaled = [](float constant, double iso) { return static_cast<double>(constant) / usual * iso; };
    const double above = std::max(s.iso - usual, 0.0) / (1.0 - usual);
    const double lower = std::min(s.iso, usual);
    settings.deep_inside = static_cast<float>(scaled(f.deep_inside, s.iso));
    f.least_value =
        static_cast<float>(scaled(f.least_value, lower) + (1.0 - static_cast<double>(f.least_value)) * above);
    f.group_lift = static_cast<float>(scaled(f.group_lift, lower));
    // A particle that can be a drop reaches as far as its share alone is above the threshold, and farther with others.
    const auto reach2 = [](float iso) { return std::max(1.0F - cube_root(iso), 0.0F); };
    const float drop2 = reach2(settings.iso) / reach2(0.6F);
    settings.blob_closest = 1.0F - std::min(0.58F * 0.58F * drop2, 1.0F);
    settings.blob_level = blob_level(s.cell_size, f.lone_support * std::sqrt(std::min(drop2, 1.0F)));
}

// One for each alternative: another does not compile without.
void use(LatticeSettings& settings, const CurvatureCriterion&) {
    settings.measures_bends = true;
}
void use(LatticeSettings& settings, const CountCriterion& criterion) {
    settings.counts_particles = true;
    settings.count_threshold = criterion.threshold;
}
void use(LatticeSettings&, const Interpolation&) {}
void use(LatticeSettings& settings, const Bisection& bisection) {
    settings.bisects = true;
    settings.bisection_steps = bisection.steps;
}

}  // namespace

LatticeSettings::LatticeSettings(const Settings& s) {
    cell_size = world_cell_size(s);
    units_per_length = units_per_cell / cell_size;
    rest_distance = 2.0 * units_per_cell / s.cell_size;
    const double support_units = meniscus::support(s) / s.cell_size * units_per_cell;
    for (unsigned k = 0; k < particle_level_count; ++k) {
        support[k] = static_cast<float>(std::ldexp(support_units, static_cast<int>(k)));
        inverse_support[k] = meniscus::inverse_support(support[k]);
        cell_units[k] = support_cell_units(static_cast<std::int64_t>(std::ceil(support[k])));
    }
    divides_by_density = s.field == Field::color;
    const double l = smoothing_length(s);
    weight = static_cast<float>(16.0 / (std::numbers::pi * l * l * l));
    iso = static_cast<float>(s.iso);
    blob_level = meniscus::blob_level(s.cell_size, 2.0 * smoothing_length(s));
    if (s.field == Field::smooth) use_smooth_field(*this, s);
    // Measured: core/README.md#the-band-085, core/README.md#drops-025-and-017.
    if (s.field == Field::color) deep_inside = static_cast<float>(s.iso * (0.85 / 0.6));
    // A lone particle's blob in the color field: W(q) = iso W(0). At iso 0.6 that is q = 0.28; a quarter support is
    // enough there.
    if (s.field == Field::color && s.iso < 1.0)
        blob_closest =
            static_cast<float>(1.0 - std::min(0.25 * lone_particle_reach(s.iso) / lone_particle_reach(0.6), 1.0));
    tolerance = static_cast<float>(meniscus::tolerance(s));
    is_adaptive = s.mode == Mode::adaptive;
    if (is_adaptive) std::visit([this](const auto& criterion) { use(*this, criterion); }, s.criterion);
    std::visit([this](const auto& edge_points) { use(*this, edge_points); }, s.edge_points);
    offset_bits = meniscus::offset_bits(s);
    has_normals = s.normals;
    may_have_attributes = s.all_attributes || !s.attributes.empty();
    if (s.domain) {
        has_domain = true;
        const auto& [low, high] = *s.domain;
        domain_low = {to_cell(std::floor(low[0] / cell_size)), to_cell(std::floor(low[1] / cell_size)),
                      to_cell(std::floor(low[2] / cell_size))};
        domain_high = {to_cell(std::ceil(high[0] / cell_size)), to_cell(std::ceil(high[1] / cell_size)),
                       to_cell(std::ceil(high[2] / cell_size))};
    }
}

}  // namespace meniscus
