#include "conversion/settings_conversion.hpp"

#include <google/protobuf/unknown_field_set.h>

#include <string>
#include <variant>
#include <vector>

#include "meniscus/error.hpp"
#include "rows/message_rows.hpp"

namespace meniscus::conversion {

namespace {

[[noreturn]] void refuse_number(std::string_view name, int value) {
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
    if (wire.has_domain()) from_wire(wire.domain(), "settings.domain");
    Settings settings;
    rows::fill_record(wire, settings, refuse_number);
    // Our own clients send a tolerance. An absent one keeps its first meaning.
    constexpr double absent_tolerance = 0.15;
    auto* const curvature = std::get_if<CurvatureCriterion>(&settings.criterion);
    if (settings.mode == Mode::adaptive && curvature != nullptr && !curvature->tolerance)
        curvature->tolerance = absent_tolerance;
    // Sessions of one surface have equal settings, whether or not their makers named a default.
    return in_force(settings);
}

v1::Settings to_wire(const Settings& settings) {
    v1::Settings wire;
    // A recording keeps its surface should a default change. A setting of another field is here only if it was given:
    // the receiver refuses it.
    rows::fill_message(in_force(settings), wire);
    // A reader from before spray was known would refuse a field of which it need not know.
    if (settings.spray == Spray::keep) wire.clear_spray();
    return wire;
}

}  // namespace meniscus::conversion
