#include "conversion/particle_arrays.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>

#include "meniscus/error.hpp"

namespace meniscus::conversion {

namespace {

struct Element {
    v1::ElementType type;
    std::string_view name;
    unsigned bytes;
};

constexpr std::array elements{
    Element{v1::ELEMENT_TYPE_FLOAT32, "float32", 4}, Element{v1::ELEMENT_TYPE_UINT8, "uint8", 1},
    Element{v1::ELEMENT_TYPE_UINT16, "uint16", 2},   Element{v1::ELEMENT_TYPE_INT32, "int32", 4},
    Element{v1::ELEMENT_TYPE_UINT32, "uint32", 4},
};
static_assert(elements.size() == v1::ElementType_ARRAYSIZE - 1, "every element type of the contract has a row");

/// What one particle has of an array.
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

std::string quoted(std::string_view name) {
    return '"' + std::string(name) + '"';
}

/// "float32 x 3 or uint16 x 3".
std::string text(std::span<const Form> forms) {
    std::string out;
    for (const Form& form : forms) {
        const auto element = std::ranges::find(elements, form.type, &Element::type);
        out += (out.empty() ? "" : " or ") + std::string(element->name) + " x " + std::to_string(form.components);
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

/// Bytes per particle, for any array.
std::uint64_t bytes_of(const v1::ParticleArray& array) {
    const auto element = std::ranges::find(elements, array.type(), &Element::type);
    if (element == elements.end())
        throw InvalidInput("array " + quoted(array.name()) + " has the element type " +
                           std::to_string(static_cast<int>(array.type())) + ", which this version does not know");
    if (array.components() < 1 || array.components() > max_array_components)
        throw InvalidInput("array " + quoted(array.name()) + " has " + std::to_string(array.components()) +
                           " components; it must have 1 to " + std::to_string(max_array_components));
    return std::uint64_t{element->bytes} * array.components();
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

[[noreturn]] void refuse_unknown(const std::string& name) {
    std::string takes;
    for (const KnownArray& known : known_arrays) takes += (takes.empty() ? "" : ", ") + quoted(known.name);
    throw InvalidInput("array " + quoted(name) + " is not known to this version, which takes " + takes);
}

void add(ParticleArrays& arrays, const KnownArray& known, const Form& form) {
    v1::ParticleArray& array = *arrays.Add();
    array.set_name(std::string(known.name));
    array.set_type(form.type);
    array.set_components(form.components);
}

}  // namespace

ParticleLayout particle_layout(const ParticleArrays& arrays, UnknownArrays unknown) {
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
        const std::uint64_t bytes = bytes_of(array);
        const auto known = std::ranges::find(known_arrays, array.name(), &KnownArray::name);
        if (known != known_arrays.end())
            require_form(*known, array);
        else if (unknown == UnknownArrays::refuse)
            refuse_unknown(array.name());
        if (array.name() == position_array.name) {
            layout.quantized = array.type() == v1::ELEMENT_TYPE_UINT16;
            layout.position_bytes = bytes;
        } else if (array.name() == level_array.name) {
            layout.has_levels = true;
            layout.levels_after = layout.particle_bytes;
        }
        layout.particle_bytes += bytes;
    }
    return layout;
}

ParticleArrays particle_arrays(bool quantized, bool has_levels) {
    ParticleArrays arrays;
    add(arrays, position_array, position_forms.at(quantized ? 1 : 0));
    if (has_levels) add(arrays, level_array, level_forms.front());
    return arrays;
}

}  // namespace meniscus::conversion
