#include "sessions/intake/brick_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

#include "conversion/attribute_conversion.hpp"
#include "conversion/statistics_conversion.hpp"
#include "meniscus/error.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/quoted.hpp"

namespace meniscus::server {

namespace {

void require_lattice(const v1::MeshBegin& mesh, const Settings& settings) {
    const auto require = [](const char* what, auto is, auto of_session) {
        if (is != of_session)
            throw InvalidInput(fmt::format("{} is {}, and {} with the session's settings: make the surface with these",
                                           what, is, of_session));
    };
    require("cell_size", mesh.cell_size(), world_cell_size(settings));
    require("offset_bits", mesh.offset_bits(), offset_bits(settings));
    require("brick_cells", mesh.brick_cells(), static_cast<std::uint32_t>(brick_cells));
    if (mesh.has_base_frame_index() || mesh.vanished_size() != 0 || mesh.run_id() != 0)
        throw InvalidInput(
            "base_frame_index, vanished or run_id is set; a frame is published whole, and open names its run");
}

std::string names_of(const std::vector<CodedAttribute>& attributes) {
    std::string names;
    for (const CodedAttribute& attribute : attributes) names += (names.empty() ? "'" : ", '") + attribute.name + "'";
    return names.empty() ? "none" : names;
}

std::vector<CodedAttribute> attributes_of(const v1::MeshBegin& mesh, const Settings& settings) {
    std::vector<CodedAttribute> attributes = conversion::coded_attributes(mesh);
    if (attributes.size() != static_cast<std::size_t>(mesh.attributes_size()))
        throw InvalidInput("an attribute has no bits; published bricks carry all attributes that are announced");
    // Without bricks there are no values: as a stream's part without particles, it need not know what others bring.
    if (attributes.empty() && mesh.brick_count() == 0) return attributes;
    const bool are_named =
        settings.all_attributes || std::ranges::equal(attributes, settings.attributes, {}, &CodedAttribute::name);
    if (!are_named) {
        std::vector<CodedAttribute> named(settings.attributes.size());
        for (std::size_t a = 0; a < named.size(); ++a) named[a].name = settings.attributes[a];
        throw InvalidInput(fmt::format("the attributes are {}; the session's settings name {}", names_of(attributes),
                                       names_of(named)));
    }
    return attributes;
}

/// Whether a number is one of the type.
bool holds(ElementType type, double number) {
    const auto within = [number](auto limits) {
        return number >= static_cast<double>(limits.lowest()) && number <= static_cast<double>(limits.max());
    };
    switch (type) {
        case ElementType::float32:
            return within(std::numeric_limits<float>());
        case ElementType::uint8:
            return within(std::numeric_limits<std::uint8_t>());
        case ElementType::int32:
            return within(std::numeric_limits<std::int32_t>());
        case ElementType::uint32:
            return within(std::numeric_limits<std::uint32_t>());
    }
    return false;
}

/// attributes: of the same message.
std::vector<AttributeRange> ranges_of(const v1::MeshBegin& mesh, const std::vector<CodedAttribute>& attributes,
                                      bool has_vertices) {
    std::vector<AttributeRange> ranges;
    for (int a = 0; a < mesh.attributes_size(); ++a) {
        const v1::MeshAttribute& wire = mesh.attributes(a);
        const CodedAttribute& coded = attributes[static_cast<std::size_t>(a)];
        if ((wire.minimum_size() != 0) != has_vertices)
            throw InvalidInput(fmt::format("attribute '{}' has {} range, and the part {} vertices", wire.name(),
                                           has_vertices ? "no" : "a", has_vertices ? "has" : "has no"));
        if (!has_vertices) continue;
        AttributeRange& range = ranges.emplace_back();
        std::ranges::copy(wire.minimum(), range.minimum.begin());
        std::ranges::copy(wire.maximum(), range.maximum.begin());
        for (std::size_t c = 0; c < coded.components; ++c)
            if (!holds(coded.type, range.minimum[c]) || !holds(coded.type, range.maximum[c]))
                throw InvalidInput(fmt::format("attribute '{}' runs from {} to {}, which is no range of {}",
                                               wire.name(), range.minimum[c], range.maximum[c], name_of(coded.type)));
        for (std::size_t c = 0; coded.bits != 0 && c < coded.components; ++c)
            if (range.minimum[c] < double{coded.minimum[c]} || range.maximum[c] > double{coded.maximum[c]})
                throw InvalidInput(
                    fmt::format("attribute '{}' runs from {} to {}, beyond its coded range from {} to {}", wire.name(),
                                range.minimum[c], range.maximum[c], coded.minimum[c], coded.maximum[c]));
    }
    return ranges;
}

/// Throws InvalidInput for a number that no reconstruction has.
void require_possible(const Statistics& statistics) {
    Statistics::rows([&](std::string_view name, auto member, const Facts&) {
        const auto require = [&](double number) {
            if (!std::isfinite(number) || number < 0.0)
                throw InvalidInput(
                    fmt::format("the statistics have {} {}; it must be finite and at least 0", name, number));
        };
        const auto& value = statistics.*member;
        using Value = std::remove_cvref_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, double>) require(value);
        if constexpr (std::is_same_v<Value, std::array<double, stage_count>>) std::ranges::for_each(value, require);
    });
}

/// The greatest number where the sum is beyond it: a publisher may say anything.
template <class Number>
Number sum(Number a, Number b) {
    if constexpr (std::is_floating_point_v<Number>)
        return std::min(a + b, std::numeric_limits<Number>::max());
    else
        return a + std::min<Number>(b, std::numeric_limits<Number>::max() - a);
}

template <class Value>
void join(Value& all, const Value& part, bool is_time) {
    if constexpr (std::is_arithmetic_v<Value>)
        all = is_time ? std::max(all, part) : sum(all, part);
    else if constexpr (std::is_same_v<Value, std::string>)
        all = all.empty() ? part : all;
    else
        for (std::size_t i = 0; i < all.size(); ++i) join(all[i], part[i], is_time);
}

void join(std::vector<Warning>& all, const std::vector<Warning>& part, bool /*is_time*/) {
    for (const Warning& warning : part)
        if (all.size() < max_warnings && std::ranges::find(all, warning.code, &Warning::code) == all.end())
            all.push_back(warning);
    std::ranges::stable_sort(all, {}, &Warning::code);
}

}  // namespace

BrickPart brick_part(const v1::PublishBegin& message, const Settings& settings) {
    const v1::MeshBegin& mesh = message.mesh();
    require_lattice(mesh, settings);
    constexpr std::uint64_t most = std::numeric_limits<std::int32_t>::max();  // of protobuf's streams
    if (message.byte_count() > most)
        throw InvalidInput(fmt::format("byte_count is {}; it must be at most {}: publish the frame in several parts",
                                       message.byte_count(), most));
    BrickPart part;
    part.bytes = static_cast<std::size_t>(message.byte_count());
    part.bricks = mesh.brick_count();
    // So that their memory is no more than some times these bytes.
    constexpr std::uint64_t least_brick_bytes = 16;
    if (part.bricks > part.bytes / least_brick_bytes)
        throw InvalidInput(fmt::format("brick_count is {}, and byte_count {}: a brick has at least {} bytes",
                                       part.bricks, part.bytes, least_brick_bytes));
    part.triangles = mesh.triangle_count();
    part.spray_points = mesh.spray_count();
    if (part.spray_points != 0 && settings.spray != Spray::points)
        throw InvalidInput(fmt::format("spray_count is {}, and the session's settings ask for none: spray is {}",
                                       part.spray_points, name_of(settings.spray)));
    part.attributes = attributes_of(mesh, settings);
    part.ranges = ranges_of(mesh, part.attributes, part.bricks != 0);
    part.statistics = conversion::from_wire(message.statistics());
    constexpr std::size_t longest_backend = 32;  // each answer of ListSessions has it
    part.statistics.backend = escaped(part.statistics.backend, longest_backend);
    require_possible(part.statistics);
    if (part.statistics.triangles != part.triangles)
        throw InvalidInput(fmt::format("the statistics have {} triangles, and triangle_count is {}",
                                       part.statistics.triangles, part.triangles));
    return part;
}

const BrickPart& lead_of(std::span<const BrickPart> parts) {
    const auto with_bricks = std::ranges::find_if(parts, [](const BrickPart& part) { return part.bricks != 0; });
    if (with_bricks != parts.end()) return *with_bricks;
    const auto naming = std::ranges::find_if(parts, [](const BrickPart& part) { return !part.attributes.empty(); });
    return naming != parts.end() ? *naming : parts.front();
}

void require_same_surface(std::span<const BrickPart> parts) {
    const BrickPart& lead = lead_of(parts);
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (parts[i].bricks != 0 && parts[i].attributes != lead.attributes)
            throw InvalidInput(
                fmt::format("part {} has the attributes {}, and part {} {}, or their types, components, bits or coded "
                            "ranges differ; in all parts of a frame they are the same",
                            i, names_of(parts[i].attributes), &lead - parts.data(), names_of(lead.attributes)));
}

std::vector<AttributeRange> joint_ranges(std::span<const BrickPart> parts) {
    std::vector<AttributeRange> joint;
    for (const BrickPart& part : parts) {
        if (joint.empty()) joint = part.ranges;
        for (std::size_t a = 0; a < part.ranges.size(); ++a)
            for (std::size_t c = 0; c < max_attribute_components; ++c) {
                joint[a].minimum[c] = std::min(joint[a].minimum[c], part.ranges[a].minimum[c]);
                joint[a].maximum[c] = std::max(joint[a].maximum[c], part.ranges[a].maximum[c]);
            }
    }
    return joint;
}

Statistics joint_statistics(std::span<const BrickPart> parts) {
    Statistics all = parts.front().statistics;
    for (const BrickPart& part : parts.subspan(1))
        Statistics::rows([&](std::string_view, auto member, const Facts& facts) {
            join(all.*member, part.statistics.*member, facts.unit == "s");
        });
    return all;
}

}  // namespace meniscus::server
