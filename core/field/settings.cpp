// The sets of settings that have a name, and the defaults that depend on the field.
#include "meniscus/settings.hpp"

#include "field/smooth_field.hpp"
#include "lattice/coordinates.hpp"

namespace meniscus {

Settings preset(Preset preset, double particle_radius) {
    Settings settings;
    settings.particle_radius = particle_radius;
    switch (preset) {
        case Preset::smooth:
            break;
        case Preset::paper:
            settings.field = Field::density;
            settings.criterion = CountCriterion{};
            settings.edge_points = Bisection{5};
            break;
        case Preset::splashsurf:
            settings.field = Field::color;
            settings.mode = Mode::uniform;
            break;
    }
    return settings;
}

double smoothing_length(const Settings& settings) {
    return settings.smoothing_length.value_or(2.0);
}

std::uint32_t smoothness(const Settings& settings) {
    return settings.smoothness.value_or(6);
}

double support(const Settings& settings) {
    return settings.field == Field::smooth ? smoothness(settings) : 2.0 * smoothing_length(settings);
}

double margin(const Settings& settings) {
    // Base cells at the border reach beyond it, as does the border itself, which is rounded outward to whole cells.
    const double cells = (base_cell_size + 1) * settings.cell_size;
    switch (settings.field) {
        case Field::density:
            return cells + support(settings);
        case Field::color:
            // The field, and the densities of the particles that it sums.
            return cells + 2.0 * support(settings);
        case Field::smooth:
            break;
    }
    // The field, the value at the places of the particles that it sums, and the company of the particles in that.
    return cells + 2.0 * support(settings) + static_cast<double>(SmoothField(smoothness(settings)).company_support);
}

double tolerance(const Settings& settings) {
    return value_or_default<CurvatureCriterion>(settings.criterion).tolerance.value_or(0.18);
}

Settings in_force(Settings settings) {
    if (settings.field == Field::smooth)
        settings.smoothness = smoothness(settings);
    else
        settings.smoothing_length = smoothing_length(settings);
    if (auto* const curvature = std::get_if<CurvatureCriterion>(&settings.criterion))
        curvature->tolerance = tolerance(settings);
    return settings;
}

}  // namespace meniscus
