#include "conversion/attribute_conversion.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "conversion/particle_arrays.hpp"
#include "meniscus/array_form.hpp"
#include "meniscus/error.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/quoted.hpp"

namespace meniscus::conversion {
namespace {

enum class EmptyName { refused, allowed };

/// Throws for a list that is too long, and for a name that cannot be one or that comes twice. noun: for messages.
template <class Named>
void require_names(const google::protobuf::RepeatedPtrField<Named>& list, const std::string& noun,
                   EmptyName empty = EmptyName::refused) {
    if (list.size() > static_cast<int>(max_particle_arrays))
        throw InvalidInput(std::to_string(list.size()) + " " + noun + "s; at most " +
                           std::to_string(max_particle_arrays) + " are possible");
    for (int i = 0; i < list.size(); ++i) {
        const std::string& name = list[i].name();
        const auto allowed = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
        if ((name.empty() && empty == EmptyName::refused) || name.size() > max_array_name_bytes ||
            !std::ranges::all_of(name, allowed))
            throw InvalidInput("the name of " + noun + " " + std::to_string(i) + " must be 1 to " +
                               std::to_string(max_array_name_bytes) + " of a-z, 0-9 and _");
        const auto before = list.begin() + i;
        if (std::any_of(list.begin(), before, [&](const Named& other) { return other.name() == name; }))
            throw InvalidInput(noun + " " + quoted(name) + " comes twice; each comes once");
    }
}

int checked_bits(std::uint32_t bits, const std::string& noun, const std::string& name) {
    if (bits > std::uint32_t{max_attribute_bits})
        throw InvalidInput(noun + " " + quoted(name) + " has " + std::to_string(bits) + " bits, must have 1 to " +
                           std::to_string(max_attribute_bits) + ", or 0 for exact values");
    return static_cast<int>(bits);
}

/// low, high: one for each component. Throws unless they are finite and in order.
template <class Ends>
void require_range(const Ends& low, const Ends& high, std::size_t components, const std::string& what) {
    if (static_cast<std::size_t>(low.size()) != components || static_cast<std::size_t>(high.size()) != components)
        throw InvalidInput(what + " has " + std::to_string(low.size()) + " lower and " + std::to_string(high.size()) +
                           " upper ends, must have " + std::to_string(components) + " of each");
    for (int c = 0; c < low.size(); ++c)
        if (!std::isfinite(low[c]) || !std::isfinite(high[c]) || low[c] > high[c])
            throw InvalidInput(what + " runs from " + std::to_string(low[c]) + " to " + std::to_string(high[c]) +
                               ", must be finite and ascending");
}

/// The attribute that a message announces, checked; coded or not.
CodedAttribute checked(const v1::MeshAttribute& wire) {
    const std::string what = "attribute " + quoted(wire.name());
    CodedAttribute attribute;
    attribute.name = wire.name();
    try {
        attribute.type = from_wire(wire.type());
    } catch (const InvalidInput& error) {
        throw InvalidInput(what + ": " + error.what());
    }
    attribute.components = wire.components();
    if (!can_be_attribute(attribute.type, attribute.components))
        throw InvalidInput(what + " is " + form_of(attribute.type, attribute.components) + ", must be " +
                           std::string(attribute_forms));
    if (wire.minimum_size() != 0 || wire.maximum_size() != 0)
        require_range(wire.minimum(), wire.maximum(), attribute.components, "the range of " + what);
    attribute.bits = checked_bits(wire.bits(), "attribute", wire.name());
    if (attribute.bits == 0) return attribute;
    if (attribute.type != ElementType::float32)
        throw InvalidInput(what + " is " + std::string(name_of(attribute.type)) + " and has " +
                           std::to_string(attribute.bits) + " bits, must have 0: only float32 is rounded");
    require_range(wire.coded_minimum(), wire.coded_maximum(), attribute.components, "the coded range of " + what);
    std::ranges::copy(wire.coded_minimum(), attribute.minimum.begin());
    std::ranges::copy(wire.coded_maximum(), attribute.maximum.begin());
    return attribute;
}

[[noreturn]] void refuse_type(const char* kind, int number) {
    throw InvalidInput(std::string("the ") + kind + " type " + std::to_string(number) +
                       " is none that this version knows of attributes, which are float32, uint8, int32 or uint32");
}

}  // namespace

v1::AttributeType attribute_type(ElementType type) {
    switch (type) {
        case ElementType::float32:
            return v1::ATTRIBUTE_TYPE_FLOAT32;
        case ElementType::uint8:
            return v1::ATTRIBUTE_TYPE_UINT8;
        case ElementType::int32:
            return v1::ATTRIBUTE_TYPE_INT32;
        case ElementType::uint32:
            return v1::ATTRIBUTE_TYPE_UINT32;
    }
    return v1::ATTRIBUTE_TYPE_UNSPECIFIED;
}

ElementType from_wire(v1::AttributeType type) {
    switch (type) {
        case v1::ATTRIBUTE_TYPE_FLOAT32:
            return ElementType::float32;
        case v1::ATTRIBUTE_TYPE_UINT8:
            return ElementType::uint8;
        case v1::ATTRIBUTE_TYPE_INT32:
            return ElementType::int32;
        case v1::ATTRIBUTE_TYPE_UINT32:
            return ElementType::uint32;
        default:
            refuse_type("attribute", static_cast<int>(type));
    }
}

v1::ElementType element_type(ElementType type) {
    switch (type) {
        case ElementType::float32:
            return v1::ELEMENT_TYPE_FLOAT32;
        case ElementType::uint8:
            return v1::ELEMENT_TYPE_UINT8;
        case ElementType::int32:
            return v1::ELEMENT_TYPE_INT32;
        case ElementType::uint32:
            return v1::ELEMENT_TYPE_UINT32;
    }
    return v1::ELEMENT_TYPE_UNSPECIFIED;
}

ElementType from_wire(v1::ElementType type) {
    switch (type) {
        case v1::ELEMENT_TYPE_FLOAT32:
            return ElementType::float32;
        case v1::ELEMENT_TYPE_UINT8:
            return ElementType::uint8;
        case v1::ELEMENT_TYPE_INT32:
            return ElementType::int32;
        case v1::ELEMENT_TYPE_UINT32:
            return ElementType::uint32;
        default:
            refuse_type("element", static_cast<int>(type));
    }
}

std::vector<AttributeWish> attribute_wishes(const AttributeWishes& wire) {
    require_names(wire, "wished attribute", EmptyName::allowed);
    std::vector<AttributeWish> wishes;
    for (const v1::AttributeWish& wish : wire)
        wishes.push_back({wish.name(), wish.has_bits() ? checked_bits(wish.bits(), "wished attribute", wish.name())
                                                       : default_attribute_bits});
    return wishes;
}

AttributeWishes to_wire(std::span<const AttributeWish> wishes) {
    AttributeWishes wire;
    for (const AttributeWish& wish : wishes) {
        v1::AttributeWish& added = *wire.Add();
        added.set_name(wish.name);
        added.set_bits(static_cast<std::uint32_t>(wish.bits));
    }
    (void)attribute_wishes(wire);
    return wire;
}

void announce(const MeshAttribute& form, const AttributeRange* range, const CodedAttribute* coded,
              v1::MeshBegin& message) {
    v1::MeshAttribute& wire = *message.add_attributes();
    wire.set_name(form.name);
    wire.set_type(attribute_type(form.type));
    wire.set_components(static_cast<std::uint32_t>(form.components));
    for (std::size_t c = 0; range != nullptr && c < form.components; ++c) {
        wire.add_minimum(range->minimum[c]);
        wire.add_maximum(range->maximum[c]);
    }
    if (coded == nullptr) return;
    wire.set_bits(static_cast<std::uint32_t>(coded->bits));
    for (std::size_t c = 0; coded->bits != 0 && c < form.components; ++c) {
        wire.add_coded_minimum(coded->minimum[c]);
        wire.add_coded_maximum(coded->maximum[c]);
    }
}

void to_wire(const Mesh& mesh, std::span<const AttributeRange> ranges, std::span<const CodedAttribute> coded,
             v1::MeshBegin& message) {
    for (std::size_t a = 0; a < mesh.attributes.size(); ++a) {
        const auto form = std::ranges::find(coded, mesh.attributes[a].name, &CodedAttribute::name);
        announce(mesh.attributes[a], ranges.empty() ? nullptr : &ranges[a], form == coded.end() ? nullptr : &*form,
                 message);
    }
}

std::vector<CodedAttribute> coded_attributes(const v1::MeshBegin& message) {
    require_names(message.attributes(), "attribute");
    std::vector<CodedAttribute> coded;
    for (const v1::MeshAttribute& wire : message.attributes()) {
        CodedAttribute attribute = checked(wire);
        if (wire.has_bits()) coded.push_back(std::move(attribute));
    }
    return coded;
}

}  // namespace meniscus::conversion
