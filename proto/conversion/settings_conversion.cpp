#include "conversion/settings_conversion.hpp"

#include <google/protobuf/unknown_field_set.h>

#include <string>
#include <vector>

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

v1::Field to_wire(Field field) {
    switch (field) {
        case Field::color:
            return v1::FIELD_COLOR;
        case Field::density:
            return v1::FIELD_DENSITY;
        case Field::smooth:
            return v1::FIELD_SMOOTH;
    }
    return v1::FIELD_UNSPECIFIED;
}

Field from_wire(v1::Field wire) {
    switch (wire) {
        case v1::FIELD_UNSPECIFIED:
        case v1::FIELD_SMOOTH:
            return Field::smooth;
        case v1::FIELD_COLOR:
            return Field::color;
        case v1::FIELD_DENSITY:
            return Field::density;
        case v1::Field_INT_MIN_SENTINEL_DO_NOT_USE_:
        case v1::Field_INT_MAX_SENTINEL_DO_NOT_USE_:
            break;
    }
    refuse_enum("field", wire);
}

v1::Spray to_wire(Spray spray) {
    switch (spray) {
        case Spray::keep:
            return v1::SPRAY_KEEP;
        case Spray::discard:
            return v1::SPRAY_DISCARD;
        case Spray::points:
            return v1::SPRAY_POINTS;
    }
    return v1::SPRAY_UNSPECIFIED;
}

Spray from_wire(v1::Spray wire) {
    switch (wire) {
        case v1::SPRAY_UNSPECIFIED:
        case v1::SPRAY_KEEP:
            return Spray::keep;
        case v1::SPRAY_DISCARD:
            return Spray::discard;
        case v1::SPRAY_POINTS:
            return Spray::points;
        case v1::Spray_INT_MIN_SENTINEL_DO_NOT_USE_:
        case v1::Spray_INT_MAX_SENTINEL_DO_NOT_USE_:
            break;
    }
    refuse_enum("spray", wire);
}

v1::Mode to_wire(Mode mode) {
    switch (mode) {
        case Mode::adaptive:
            return v1::MODE_ADAPTIVE;
        case Mode::uniform:
            return v1::MODE_UNIFORM;
    }
    return v1::MODE_UNSPECIFIED;
}

Mode from_wire(v1::Mode wire) {
    switch (wire) {
        case v1::MODE_UNSPECIFIED:
        case v1::MODE_ADAPTIVE:
            return Mode::adaptive;
        case v1::MODE_UNIFORM:
            return Mode::uniform;
        case v1::Mode_INT_MIN_SENTINEL_DO_NOT_USE_:
        case v1::Mode_INT_MAX_SENTINEL_DO_NOT_USE_:
            break;
    }
    refuse_enum("mode", wire);
}

void to_wire(const CurvatureCriterion& criterion, v1::Settings& wire) {
    v1::CurvatureCriterion& curvature = *wire.mutable_curvature();
    if (criterion.tolerance) curvature.set_tolerance(*criterion.tolerance);
}
void to_wire(const CountCriterion& criterion, v1::Settings& wire) {
    wire.mutable_count()->set_threshold(criterion.threshold);
}
void to_wire(const Interpolation&, v1::Settings& wire) {
    wire.mutable_interpolate();
}
void to_wire(const Bisection& bisection, v1::Settings& wire) {
    wire.mutable_bisect()->set_steps(bisection.steps);
}

Criterion criterion_from_wire(const v1::Settings& wire) {
    switch (wire.criterion_case()) {
        case v1::Settings::kCurvature: {
            CurvatureCriterion criterion;
            if (wire.curvature().has_tolerance()) criterion.tolerance = wire.curvature().tolerance();
            return criterion;
        }
        case v1::Settings::kCount: {
            CountCriterion criterion;
            if (wire.count().has_threshold()) criterion.threshold = wire.count().threshold();
            return criterion;
        }
        case v1::Settings::CRITERION_NOT_SET:
            break;
    }
    return Settings{}.criterion;
}

EdgePoints edge_points_from_wire(const v1::Settings& wire) {
    switch (wire.edge_points_case()) {
        case v1::Settings::kInterpolate:
            return Interpolation{};
        case v1::Settings::kBisect: {
            Bisection bisection;
            if (wire.bisect().has_steps()) bisection.steps = wire.bisect().steps();
            return bisection;
        }
        case v1::Settings::EDGE_POINTS_NOT_SET:
            break;
    }
    return Settings{}.edge_points;
}

/// A choice that this version cannot make must not fall back to a default.
void refuse_unknown_fields(const google::protobuf::Message& message, const std::string& name) {
    const google::protobuf::Reflection& reflection = *message.GetReflection();
    const auto& unknown = reflection.GetUnknownFields(message);
    if (!unknown.empty())
        throw InvalidInput(name + " have the field " + std::to_string(unknown.field(0).number()) +
                           ", which this version does not know: they come from another version of Meniscus");
    std::vector<const google::protobuf::FieldDescriptor*> fields;
    reflection.ListFields(message, &fields);
    for (const auto* field : fields)
        if (!field->is_repeated() && field->cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_MESSAGE)
            refuse_unknown_fields(reflection.GetMessage(message, field), name);
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
    refuse_unknown_fields(wire, "settings");
    Settings settings;
    settings.particle_radius = wire.particle_radius();
    if (wire.has_cell_size()) settings.cell_size = wire.cell_size();
    if (wire.has_iso()) settings.iso = wire.iso();
    settings.field = from_wire(wire.field());
    if (wire.has_smoothing_length()) settings.smoothing_length = wire.smoothing_length();
    if (wire.has_smoothness()) settings.smoothness = wire.smoothness();
    settings.spray = from_wire(wire.spray());
    settings.mode = from_wire(wire.mode());
    settings.criterion = criterion_from_wire(wire);
    settings.edge_points = edge_points_from_wire(wire);
    if (wire.has_normals()) settings.normals = wire.normals();
    if (wire.has_domain()) settings.domain = from_wire(wire.domain(), "settings.domain");
    settings.attributes.assign(wire.attributes().begin(), wire.attributes().end());
    settings.all_attributes = wire.all_attributes();
    // Sessions of one surface have equal settings, whether or not their makers named a default.
    return in_force(settings);
}

v1::Settings to_wire(const Settings& given) {
    // A recording keeps its surface should a default change.
    const Settings settings = in_force(given);
    v1::Settings wire;
    wire.set_particle_radius(settings.particle_radius);
    wire.set_cell_size(settings.cell_size);
    wire.set_iso(settings.iso);
    wire.set_field(to_wire(settings.field));
    // A setting of another field is here only if it was given: the receiver refuses it.
    if (settings.smoothing_length) wire.set_smoothing_length(*settings.smoothing_length);
    if (settings.smoothness) wire.set_smoothness(*settings.smoothness);
    // A reader from before spray was known would refuse a field of which it need not know.
    if (settings.spray != Spray::keep) wire.set_spray(to_wire(settings.spray));
    wire.set_mode(to_wire(settings.mode));
    std::visit([&](const auto& criterion) { to_wire(criterion, wire); }, settings.criterion);
    std::visit([&](const auto& edge_points) { to_wire(edge_points, wire); }, settings.edge_points);
    wire.set_normals(settings.normals);
    if (settings.domain) *wire.mutable_domain() = to_wire(*settings.domain);
    wire.mutable_attributes()->Assign(settings.attributes.begin(), settings.attributes.end());
    wire.set_all_attributes(settings.all_attributes);
    return wire;
}

}  // namespace meniscus::conversion
