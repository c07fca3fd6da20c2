#include "mesh_particles.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <span>

#include "formats/containers/array_collector.hpp"
#include "meniscus/element_type.hpp"
#include "meniscus/error.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/quoted.hpp"

namespace meniscus::catalyst {
namespace {

std::string text_at(const Node& node, const std::string& path) {
    return node.at(path).text().value_or("");
}

/// Of points: implicitly one for each of the coordset, or elements of that shape.
bool has_points(const Node& topology) {
    return text_at(topology, "type") == "points" || text_at(topology, "elements/shape") == "point";
}

/// The first topology whose elements are points.
Node points_of(const Node& mesh, Notices& notices) {
    std::optional<Node> found;
    for (const Node& topology : mesh.at("topologies").children()) {
        if (!found && has_points(topology)) {
            found = topology;
            continue;
        }
        const std::string what =
            has_points(topology) ? "the first one of points is taken" : "its elements are no points, must be particles";
        notices.say_once("topology " + quoted(topology.name()) + " is passed over: " + what);
    }
    if (!found)
        throw InvalidInput(
            "the mesh has no topology of points: topologies/NAME/type must be points, or unstructured with "
            "elements/shape "
            "point");
    return *found;
}

/// Copies elements that lie `stride` bytes apart to places that are `step` elements apart.
template <class From, class To>
void gather(const Numbers& from, To* to, std::size_t step) {
    for (std::size_t i = 0; i < from.count; ++i) {
        From number;
        std::memcpy(&number, from.first + static_cast<std::ptrdiff_t>(i) * from.stride, sizeof number);
        to[i * step] = static_cast<To>(number);
    }
}

/// x y z that the caller has apart.
template <class Number>
const Number* interleaved(std::span<const Numbers, 3> axes, std::vector<Number>& positions) {
    positions.resize(3 * axes[0].count);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (axes[axis].type == NumberType::float32)
            gather<float>(axes[axis], positions.data() + axis, 3);
        else
            gather<double>(axes[axis], positions.data() + axis, 3);
    }
    return positions.data();
}

/// What numbers of a field are as an attribute.
struct AttributeType {
    NumberType from;
    ElementType type;
    meniscus_type in_c;
};
constexpr std::array<AttributeType, 5> attribute_types{{
    {NumberType::float32, ElementType::float32, MENISCUS_FLOAT32},
    {NumberType::float64, ElementType::float32, MENISCUS_FLOAT32},
    {NumberType::uint8, ElementType::uint8, MENISCUS_UINT8},
    {NumberType::int32, ElementType::int32, MENISCUS_INT32},
    {NumberType::uint32, ElementType::uint32, MENISCUS_UINT32},
}};

void gather_component(const Numbers& from, std::byte* to, std::size_t components) {
    switch (from.type) {
        case NumberType::float64:
            return gather<double>(from, reinterpret_cast<float*>(to), components);
        case NumberType::uint8:
            return gather<std::uint8_t>(from, reinterpret_cast<std::uint8_t*>(to), components);
        default:  // of four bytes
            return gather<std::uint32_t>(from, reinterpret_cast<std::uint32_t*>(to), components);
    }
}

/// Whether the components lie as an array of the C interface does.
bool together(std::span<const Numbers> parts, std::size_t bytes) {
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (parts[i].type == NumberType::float64 || parts[i].first != parts[0].first + i * bytes ||
            parts[i].stride != static_cast<std::ptrdiff_t>(parts.size() * bytes))
            return false;
    return true;
}

}  // namespace

const meniscus_particles& MeshParticles::empty() {
    particles_ = MENISCUS_PARTICLES_INIT;
    return particles_;
}

void MeshParticles::read_positions(const Node& values) {
    std::array<Numbers, 3> axes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::string name(1, "xyz"[axis]);
        const Node node = values.at(name);
        axes[axis] = node.numbers();
        const NumberType type = axes[axis].type;
        const std::string number = "coordset values/" + name;
        if (!node) throw InvalidInput(number + " is missing, particles have x, y and z");
        // An array without elements may have no type.
        if (axes[axis].count != 0 && type != NumberType::float32 && type != NumberType::float64)
            throw InvalidInput(number + " is " + name_of(type) + ", must be float32 or float64");
        if (axes[axis].count != axes[0].count)
            throw InvalidInput(number + " has " + std::to_string(axes[axis].count) + " numbers, must have " +
                               std::to_string(axes[0].count) + " as values/x has");
    }
    particles_.count = axes[0].count;
    if (particles_.count == 0) return;
    const bool all_float = std::ranges::all_of(axes, [](const Numbers& a) { return a.type == NumberType::float32; });
    const std::size_t bytes = all_float ? sizeof(float) : sizeof(double);
    // As the C interface takes axes: strides of one number or more.
    const bool alike = std::ranges::all_of(axes, [&](const Numbers& axis) {
        return axis.type == axes[0].type && axis.stride == axes[0].stride &&
               axis.stride >= static_cast<std::ptrdiff_t>(bytes);
    });
    if (alike) {
        particles_.stride = static_cast<std::size_t>(axes[0].stride);
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (all_float)
                particles_.axes[axis] = reinterpret_cast<const float*>(axes[axis].first);
            else
                particles_.axes_double[axis] = reinterpret_cast<const double*>(axes[axis].first);
    } else if (all_float) {
        particles_.positions = interleaved(axes, floats_);
    } else {
        particles_.positions_double = interleaved(axes, doubles_);
    }
}

std::string MeshParticles::read_field(const Node& field, const std::string& name) {
    if (const std::string association = text_at(field, "association"); association != "vertex")
        return "its association is " + quoted(association) + ", must be vertex";
    if (name == "position" || name == "level") return "a name with another meaning";
    if (std::ranges::find(names_, name) != names_.end()) return "the name of another field";
    if (arrays_.size() == max_particle_arrays) return "after the first " + std::to_string(max_particle_arrays);
    const Node values = field.at("values");
    std::vector<Numbers> parts;
    for (const Node& component : values.children()) parts.push_back(component.numbers());
    if (parts.empty()) parts.push_back(values.numbers());

    const auto* const type = std::ranges::find(attribute_types, parts[0].type, &AttributeType::from);
    const bool alike = std::ranges::all_of(parts, [&](const Numbers& part) { return part.type == parts[0].type; });
    if (type == attribute_types.end() || !alike || !can_be_attribute(type->type, parts.size()))
        return std::to_string(parts.size()) + " of " + (alike ? name_of(parts[0].type) : "several types") +
               ", must be 1, 3 or 4 of float32, float64 or uint8, or 1 of int32 or uint32";
    for (const Numbers& part : parts)
        if (part.count != particles_.count)
            throw InvalidInput("field " + quoted(field.name()) + " has " + std::to_string(part.count) +
                               " numbers, must have one for each of " + std::to_string(particles_.count) + " points");
    const std::size_t bytes = size_of(type->type);
    meniscus_array array{names_.emplace_back(name).c_str(), type->in_c, static_cast<std::uint32_t>(parts.size()),
                         parts[0].first};
    if (!together(parts, bytes)) {
        std::vector<std::byte>& memory = gathered_.emplace_back(particles_.count * parts.size() * bytes);
        for (std::size_t i = 0; i < parts.size(); ++i)
            gather_component(parts[i], memory.data() + i * bytes, parts.size());
        array.data = memory.data();
    }
    arrays_.push_back(array);
    return {};
}

void MeshParticles::read_fields(const Node& mesh, const std::string& topology, const RunOptions& options,
                                Notices& notices) {
    for (const Node& field : mesh.at("fields").children()) {
        if (text_at(field, "topology") != topology) continue;
        const std::string name = formats::array_name(field.name());
        if (!options.all_attributes && std::ranges::find(options.attributes, name) == options.attributes.end())
            continue;
        if (const std::string reason = read_field(field, name); !reason.empty())
            notices.say_once("field " + quoted(field.name()) + " is passed over: " + reason);
    }
}

const meniscus_particles& MeshParticles::read(const Node& mesh, const RunOptions& options, Notices& notices) {
    empty();
    arrays_.clear();
    names_.clear();
    gathered_.clear();
    const Node topology = points_of(mesh, notices);
    const std::string coordset = text_at(topology, "coordset");
    const Node coords = mesh.at("coordsets/" + coordset);
    if (coordset.empty() || !coords)
        throw InvalidInput("topology " + quoted(topology.name()) + " names coordset " + quoted(coordset) +
                           ", which is not there");
    if (const std::string type = text_at(coords, "type"); type != "explicit")
        throw InvalidInput("coordset " + quoted(coordset) + " is of type " + quoted(type) + ", must be explicit");
    read_positions(coords.at("values"));
    if (particles_.count != 0) read_fields(mesh, topology.name(), options, notices);
    particles_.arrays = arrays_.data();
    particles_.array_count = arrays_.size();
    return particles_;
}

}  // namespace meniscus::catalyst
