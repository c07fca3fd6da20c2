// The rules for names and forms are those of the contract (proto/meniscus/v1/surface_service.proto).
#include "particles/attribute_choice.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

#include "meniscus/array_form.hpp"
#include "meniscus/error.hpp"
#include "meniscus/quoted.hpp"
#include "meniscus/reconstructor.hpp"

namespace meniscus {
namespace {

void require_name(std::string_view name) {
    const auto is_allowed = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
    if (name.empty() || name.size() > max_array_name_bytes || !std::all_of(name.begin(), name.end(), is_allowed))
        throw InvalidInput("the attribute " + quoted(name) +
                           " has a name that no array can have: 1 to 64 of the characters a-z, 0-9 and _");
    if (name == "position" || name == "level")
        throw InvalidInput("the attribute " + quoted(name) +
                           " is what the surface is made from: name arrays of other values");
}

/// The array of a name; none if there is none.
const ParticleArray* find(const ParticleFrame& frame, std::string_view name) {
    const ParticleArray* found = nullptr;
    for (const ParticleArray& array : frame.arrays) {
        if (array.name != name) continue;
        if (found != nullptr) throw InvalidInput("array " + quoted(name) + " comes twice in the frame, must come once");
        found = &array;
    }
    if (found != nullptr && !can_be_attribute(found->type, found->components))
        throw InvalidInput("array " + quoted(name) + " is " + form_of(found->type, found->components) +
                           ", an attribute must be " + std::string(attribute_forms));
    return found;
}

bool is_finite_in_order(std::uint32_t ordered) {
    return std::isfinite(from_ordered_bits(ordered));
}

/// The index of a float32 array's first value that is not finite, which there is.
std::uint64_t first_not_finite(const ParticleArray& array) {
    for (std::uint64_t value = 0;; ++value) {
        float v = 0.0F;
        std::memcpy(&v, array.data.data() + sizeof v * value, sizeof v);
        if (!std::isfinite(v)) return value;
    }
}

}  // namespace

void validate_attribute_names(const Settings& settings) {
    const std::vector<std::string>& names = settings.attributes;
    if (settings.all_attributes && !names.empty())
        throw InvalidInput("the settings name " + quoted(names.front()) +
                           " among the attributes and ask for all, must do one of these");
    if (names.size() > max_particle_arrays)
        throw InvalidInput("the settings name " + std::to_string(names.size()) + " attributes, at most " +
                           std::to_string(max_particle_arrays) + " are possible");
    for (auto name = names.begin(); name != names.end(); ++name) {
        require_name(*name);
        if (std::find(names.begin(), name, *name) != name)
            throw InvalidInput("the settings name the attribute " + quoted(*name) + " twice, must name it once");
    }
}

AttributeChoice::AttributeChoice(const Settings& settings)
    : names_(settings.attributes), takes_all_(settings.all_attributes) {}

std::vector<ParticleArray> AttributeChoice::of(const ParticleFrame& frame) const {
    std::vector<ParticleArray> chosen;
    const auto choose = [&](std::string_view name) {
        const ParticleArray* const array = find(frame, name);
        if (array != nullptr) chosen.push_back(*array);
        return array != nullptr;
    };
    if (takes_all_ && names_.empty()) {
        for (const ParticleArray& array : frame.arrays) {
            require_name(array.name);
            choose(array.name);
        }
        return chosen;
    }
    for (std::size_t i = 0; i < names_.size(); ++i) {
        if (!choose(names_[i])) {
            if (frame.count() == 0) return {};
            throw InvalidInput("the frame has no array " + quoted(names_[i]) +
                               (takes_all_ ? ", which frames before it brought: attributes must come with every frame"
                                           : ", which the settings name among the attributes: send it with every "
                                             "frame, or leave it out of the settings"));
        }
        const ParticleArray& array = chosen.back();
        if (!forms_.empty() && (array.type != forms_[i].type || array.components != forms_[i].components))
            throw InvalidInput("array " + quoted(array.name) + " is " + form_of(array.type, array.components) +
                               ", must be as in the frames before: " + form_of(forms_[i].type, forms_[i].components));
    }
    return chosen;
}

void AttributeChoice::keep(std::span<const ParticleArray> chosen) {
    if (!forms_.empty()) return;
    // All of them or none: processes that disagree would refuse each other's frames.
    std::vector<Form> forms;
    std::vector<std::string> names;
    for (const ParticleArray& array : chosen) {
        forms.push_back({std::string(array.name), array.type, array.components});
        names.push_back(forms.back().name);
    }
    forms_.swap(forms);
    if (takes_all_) names_.swap(names);
}

void AttributeChoice::shape(Mesh& mesh, const std::shared_ptr<MemoryAccount>& account) const {
    const auto fits = [&](const MeshAttribute& attribute, const Form& form) {
        return attribute.name == form.name && attribute.type == form.type && attribute.components == form.components &&
               attribute.data.get_allocator().account() == account;
    };
    if (std::equal(mesh.attributes.begin(), mesh.attributes.end(), forms_.begin(), forms_.end(), fits)) return;
    mesh.attributes.clear();
    for (const Form& form : forms_)
        mesh.attributes.push_back(
            {form.name, form.type, form.components, Array<std::byte>(AccountAllocator<std::byte>(account))});
}

void AttributeChoice::describe(std::vector<DeviceMeshAttribute>& attributes) const {
    for (std::size_t i = 0; i < attributes.size(); ++i)
        attributes[i] = {forms_[i].name, forms_[i].type, forms_[i].components, attributes[i].data};
}

void refuse_value(const ParticleArray& array, std::uint64_t value) {
    throw InvalidInput("particle " + std::to_string(value / array.components) + " has a value of " +
                       quoted(array.name) + " that is not finite" +
                       (array.components == 1 ? "" : " (component " + std::to_string(value % array.components) + ")") +
                       ": attributes must be finite");
}

AttributeNumbers numbers_in_host_memory(std::span<const ParticleArray> chosen) {
    AttributeNumbers numbers = attribute_numbers(chosen);
    for (unsigned i = 0; i < numbers.shape.amounts; ++i) {
        AttributeNumber& number = numbers.of[i];
        const ParticleArray& array = chosen[number.array];
        if (number.type == ElementType::uint8) {
            set_range_of_bytes(number);
            continue;
        }
        if (array.data.empty()) continue;
        std::uint32_t least = ~std::uint32_t{0}, greatest = 0;
        const std::size_t step = array.element_bytes();
        for (std::size_t at = 4 * std::size_t{number.component}; at < array.data.size(); at += step) {
            std::uint32_t bits = 0;
            std::memcpy(&bits, array.data.data() + at, sizeof bits);
            const std::uint32_t ordered = ordered_bits(bits);
            least = std::min(least, ordered);
            greatest = std::max(greatest, ordered);
        }
        if (!is_finite_in_order(least) || !is_finite_in_order(greatest)) refuse_value(array, first_not_finite(array));
        set_range(number, from_ordered_bits(least), from_ordered_bits(greatest));
    }
    return numbers;
}

namespace {

/// Whether the number has a range of its array.
bool is_ranged(const AttributeNumber& number, std::span<const ParticleArray> chosen) {
    return number.type == ElementType::float32 && !chosen[number.array].data.empty();
}

std::uint32_t order_of(float value) {
    return ordered_bits(AttributeNumber::as_bits(value));
}

void widen(ArrayRange& range, float least, float greatest) {
    if (order_of(least) < order_of(range.least)) range.least = least;
    if (order_of(greatest) > order_of(range.greatest)) range.greatest = greatest;
}

ArrayRange* find(std::vector<ArrayRange>& ranges, const ArrayRange& wanted) {
    for (ArrayRange& range : ranges)
        if (range.name == wanted.name && range.component == wanted.component) return &range;
    return nullptr;
}

}  // namespace

std::vector<ArrayRange> array_ranges(const ParticleFrame& frame, const Settings& settings) {
    validate_lengths(frame);
    const std::vector<ParticleArray> chosen = AttributeChoice(settings).of(frame);
    const AttributeNumbers numbers = numbers_in_host_memory(chosen);
    std::vector<ArrayRange> ranges;
    for (unsigned i = 0; i < numbers.shape.amounts; ++i)
        if (const AttributeNumber& number = numbers.of[i]; is_ranged(number, chosen))
            ranges.push_back({std::string(chosen[number.array].name), number.component, number.least, number.greatest});
    return ranges;
}

void widen(std::vector<ArrayRange>& ranges, const std::vector<ArrayRange>& others) {
    for (const ArrayRange& other : others) {
        if (ArrayRange* const range = find(ranges, other))
            widen(*range, other.least, other.greatest);
        else
            ranges.push_back(other);
    }
}

void set_ranges(AttributeNumbers& numbers, std::span<const ParticleArray> chosen, std::span<const ArrayRange> ranges) {
    for (unsigned i = 0; i < numbers.shape.amounts; ++i) {
        AttributeNumber& number = numbers.of[i];
        if (!is_ranged(number, chosen)) continue;
        for (const ArrayRange& range : ranges) {
            if (range.name != chosen[number.array].name || range.component != number.component) continue;
            const bool holds = order_of(range.least) <= order_of(number.least) &&
                               order_of(range.greatest) >= order_of(number.greatest);
            if (!holds || !std::isfinite(range.least) || !std::isfinite(range.greatest))
                throw InvalidInput("the range of " + quoted(range.name) + " in the whole frame is " +
                                   std::to_string(range.least) + " to " + std::to_string(range.greatest) +
                                   ", but a part of it reaches from " + std::to_string(number.least) + " to " +
                                   std::to_string(number.greatest) + ": ranges are those over all particles");
            set_range(number, range.least, range.greatest);
        }
    }
}

}  // namespace meniscus
