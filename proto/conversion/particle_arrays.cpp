#include "conversion/particle_arrays.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "meniscus/array_form.hpp"
#include "meniscus/error.hpp"
#include "meniscus/quoted.hpp"

namespace meniscus::conversion {

namespace {

struct Element {
    v1::ElementType type;
    std::string_view name;
    unsigned bytes;
    std::optional<ElementType> in_core;
};

constexpr Element element_of(v1::ElementType type, ElementType in_core) {
    return {type, name_of(in_core), static_cast<unsigned>(size_of(in_core)), in_core};
}

constexpr std::array elements{
    element_of(v1::ELEMENT_TYPE_FLOAT32, ElementType::float32),  element_of(v1::ELEMENT_TYPE_UINT8, ElementType::uint8),
    Element{v1::ELEMENT_TYPE_UINT16, "uint16", 2, std::nullopt}, element_of(v1::ELEMENT_TYPE_INT32, ElementType::int32),
    element_of(v1::ELEMENT_TYPE_UINT32, ElementType::uint32),
};
static_assert(elements.size() == v1::ElementType_ARRAYSIZE - 1, "every element type of the contract has a row");

/// The form of one particle's values in an array.
struct Form {
    v1::ElementType type;
    std::uint32_t components;
};

struct KnownArray {
    std::string_view name;
    std::span<const Form> forms;
};

constexpr std::array position_forms{Form{v1::ELEMENT_TYPE_FLOAT32, 3}, Form{v1::ELEMENT_TYPE_UINT16, 3}};
constexpr std::array level_forms{Form{v1::ELEMENT_TYPE_UINT8, 1}};
constexpr KnownArray position_array{"position", position_forms};
constexpr KnownArray level_array{"level", level_forms};
constexpr std::array known_arrays{position_array, level_array};

/// "float32 of 3 components or uint16 of 3 components".
std::string text(std::span<const Form> forms) {
    std::string out;
    for (const Form& form : forms) {
        const auto element = std::ranges::find(elements, form.type, &Element::type);
        out += (out.empty() ? "" : " or ") + meniscus::form_of(element->name, form.components);
    }
    return out;
}

/// Throws unless the name can stand in messages and logs as it is.
void require_name(const std::string& name, int place) {
    if (name.empty() || name.size() > max_array_name_bytes)
        throw InvalidInput("the name of array " + std::to_string(place) + " has " + std::to_string(name.size()) +
                           " bytes; it must have 1 to " + std::to_string(max_array_name_bytes));
    for (const char c : name)
        if (!((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'))
            throw InvalidInput("the name of array " + std::to_string(place) + " has the byte " +
                               std::to_string(static_cast<unsigned char>(c)) + "; it must be of a-z, 0-9 and _");
}

/// Any array, as one beside positions and levels. after: bytes per particle of those before it.
FurtherArray described(const v1::ParticleArray& array, std::uint64_t after) {
    const auto element = std::ranges::find(elements, array.type(), &Element::type);
    if (element == elements.end())
        throw InvalidInput("array " + quoted(array.name()) + " has the element type " +
                           std::to_string(static_cast<int>(array.type())) + ", which this version does not know");
    if (array.components() < 1 || array.components() > max_array_components)
        throw InvalidInput("array " + quoted(array.name()) + " has " + std::to_string(array.components()) +
                           " components; it must have 1 to " + std::to_string(max_array_components));
    return {.name = array.name(),
            .type = element->in_core,
            .components = array.components(),
            .bytes = std::uint64_t{element->bytes} * array.components(),
            .after = after};
}

void require_form(const KnownArray& known, const v1::ParticleArray& array) {
    const auto is_array = [&](const Form& form) {
        return form.type == array.type() && form.components == array.components();
    };
    if (std::ranges::any_of(known.forms, is_array)) return;
    const Form found{array.type(), array.components()};
    throw InvalidInput("array " + quoted(array.name()) + " is " + text({&found, 1}) + "; it must be " +
                       text(known.forms));
}

void add(ParticleArrays& arrays, std::string_view name, const Form& form) {
    v1::ParticleArray& array = *arrays.Add();
    array.set_name(std::string(name));
    array.set_type(form.type);
    array.set_components(form.components);
}

}  // namespace

std::string form_of(const FurtherArray& array) {
    const auto element = std::ranges::find(elements, array.type, &Element::in_core);
    return meniscus::form_of(element->name, array.components);
}

ParticleLayout particle_layout(const ParticleArrays& arrays) {
    if (arrays.size() > max_announced_arrays)
        throw InvalidInput(std::to_string(arrays.size()) + " arrays; at most " + std::to_string(max_announced_arrays) +
                           " are taken");
    if (arrays.empty()) throw InvalidInput("no arrays; the first must be " + quoted(position_array.name));
    ParticleLayout layout;
    for (int i = 0; i < arrays.size(); ++i) {
        const v1::ParticleArray& array = arrays[i];
        require_name(array.name(), i);
        if (i == 0 && array.name() != position_array.name)
            throw InvalidInput("the first array is " + quoted(array.name()) + "; it must be " +
                               quoted(position_array.name));
        const auto before = arrays.begin() + i;
        if (std::any_of(arrays.begin(), before, [&](const auto& other) { return other.name() == array.name(); }))
            throw InvalidInput("array " + quoted(array.name()) + " comes twice; each comes once");
        FurtherArray further = described(array, layout.particle_bytes);
        layout.particle_bytes += further.bytes;
        const auto known = std::ranges::find(known_arrays, array.name(), &KnownArray::name);
        if (known != known_arrays.end()) require_form(*known, array);
        if (array.name() == position_array.name) {
            layout.quantized = array.type() == v1::ELEMENT_TYPE_UINT16;
            layout.position_bytes = further.bytes;
        } else if (array.name() == level_array.name) {
            layout.has_levels = true;
            layout.levels_after = further.after;
        } else {
            layout.further.push_back(std::move(further));
        }
    }
    return layout;
}

ParticleArrays particle_arrays(bool quantized, bool has_levels, std::span<const ParticleArray> further) {
    ParticleArrays arrays;
    add(arrays, position_array.name, position_forms.at(quantized ? 1 : 0));
    if (has_levels) add(arrays, level_array.name, level_forms.front());
    for (const ParticleArray& array : further) {
        const auto element = std::ranges::find(elements, std::optional(array.type), &Element::in_core);
        add(arrays, array.name, {element->type, static_cast<std::uint32_t>(array.components)});
    }
    return arrays;
}

}  // namespace meniscus::conversion
