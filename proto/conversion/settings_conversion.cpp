#include "conversion/settings_conversion.hpp"

#include <string>

#include "meniscus/error.hpp"

namespace meniscus::conversion {

namespace {

[[noreturn]] void refuse_enum(std::string_view name, int value) {
    throw InvalidInput("settings." + std::string(name) + " has the value " + std::to_string(value) +
                       ", which this version does not know");
}

std::array<double, 3> from_wire(const v1::Vector3& wire) {
    return {wire.x(), wire.y(), wire.z()};
}

void to_wire(const std::array<double, 3>& vector, v1::Vector3& wire) {
    wire.set_x(vector[0]);
    wire.set_y(vector[1]);
    wire.set_z(vector[2]);
}

Field field_from_wire(v1::Field wire) {
    switch (wire) {
        case v1::FIELD_UNSPECIFIED:
        case v1::FIELD_COLOR:
            return Field::color;
        case v1::FIELD_DENSITY:
            return Field::density;
        default:
            refuse_enum("field", wire);
    }
}

Mode mode_from_wire(v1::Mode wire) {
    switch (wire) {
        case v1::MODE_UNSPECIFIED:
        case v1::MODE_ADAPTIVE:
            return Mode::adaptive;
        case v1::MODE_UNIFORM:
            return Mode::uniform;
        default:
            refuse_enum("mode", wire);
    }
}

Criterion criterion_from_wire(v1::Criterion wire) {
    switch (wire) {
        case v1::CRITERION_UNSPECIFIED:
        case v1::CRITERION_CURVATURE:
            return Criterion::curvature;
        case v1::CRITERION_COUNT:
            return Criterion::count;
        default:
            refuse_enum("criterion", wire);
    }
}

EdgePoints edge_points_from_wire(v1::EdgePoints wire) {
    switch (wire) {
        case v1::EDGE_POINTS_UNSPECIFIED:
        case v1::EDGE_POINTS_INTERPOLATE:
            return EdgePoints::interpolate;
        case v1::EDGE_POINTS_BISECT:
            return EdgePoints::bisect;
        default:
            refuse_enum("edge_points", wire);
    }
}

}  // namespace

Box from_wire(const v1::Box& wire, std::string_view name) {
    if (!wire.has_min() || !wire.has_max())
        throw InvalidInput(std::string(name) + " needs both its corners, min and max");
    return {.min = from_wire(wire.min()), .max = from_wire(wire.max())};
}

v1::Box to_wire(const Box& box) {
    v1::Box wire;
    to_wire(box.min, *wire.mutable_min());
    to_wire(box.max, *wire.mutable_max());
    return wire;
}

Settings from_wire(const v1::Settings& wire) {
    Settings settings;
    settings.particle_radius = wire.particle_radius();
    if (wire.has_smoothing_length()) settings.smoothing_length = wire.smoothing_length();
    if (wire.has_cell_size()) settings.cell_size = wire.cell_size();
    if (wire.has_iso()) settings.iso = wire.iso();
    settings.field = field_from_wire(wire.field());
    settings.mode = mode_from_wire(wire.mode());
    settings.criterion = criterion_from_wire(wire.criterion());
    if (wire.has_tolerance()) settings.tolerance = wire.tolerance();
    if (wire.has_count_threshold()) settings.count_threshold = wire.count_threshold();
    settings.edge_points = edge_points_from_wire(wire.edge_points());
    if (wire.has_bisection_steps()) settings.bisection_steps = wire.bisection_steps();
    if (wire.has_normals()) settings.normals = wire.normals();
    if (wire.has_domain()) settings.domain = from_wire(wire.domain(), "settings.domain");
    return settings;
}

v1::Settings to_wire(const Settings& settings) {
    v1::Settings wire;
    wire.set_particle_radius(settings.particle_radius);
    wire.set_smoothing_length(settings.smoothing_length);
    wire.set_cell_size(settings.cell_size);
    wire.set_iso(settings.iso);
    wire.set_field(settings.field == Field::density ? v1::FIELD_DENSITY : v1::FIELD_COLOR);
    wire.set_mode(settings.mode == Mode::uniform ? v1::MODE_UNIFORM : v1::MODE_ADAPTIVE);
    wire.set_criterion(settings.criterion == Criterion::count ? v1::CRITERION_COUNT : v1::CRITERION_CURVATURE);
    wire.set_tolerance(settings.tolerance);
    wire.set_count_threshold(settings.count_threshold);
    wire.set_edge_points(settings.edge_points == EdgePoints::bisect ? v1::EDGE_POINTS_BISECT
                                                                    : v1::EDGE_POINTS_INTERPOLATE);
    wire.set_bisection_steps(settings.bisection_steps);
    wire.set_normals(settings.normals);
    if (settings.domain) *wire.mutable_domain() = to_wire(*settings.domain);
    return wire;
}

}  // namespace meniscus::conversion
