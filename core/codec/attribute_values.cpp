#include "codec/attribute_values.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>

#include "meniscus/array_form.hpp"
#include "meniscus/error.hpp"

namespace meniscus {
namespace {

static_assert(std::endian::native == std::endian::little, "values are coded as they lie in memory");

template <class Number>
Number number_at(std::span<const std::byte> bytes, std::size_t place) {
    Number number;
    std::memcpy(&number, bytes.data() + place * sizeof number, sizeof number);
    return number;
}

template <class Number>
void set_number_at(std::span<std::byte> bytes, std::size_t place, Number number) {
    std::memcpy(bytes.data() + place * sizeof number, &number, sizeof number);
}

/// Number: type of a component.
template <class Number>
void code_numbers(const MeshAttribute& attribute, const CodedAttribute& form, std::span<const std::uint32_t> vertices,
                  std::span<std::byte> coded) {
    for (std::size_t c = 0; c < form.components; ++c) {
        const CodedRange range(form, c);
        for (std::size_t i = 0; i < vertices.size(); ++i)
            set_number_at(
                coded, i * form.components + c,
                static_cast<Number>(range.number(number_at<float>(attribute.data, vertices[i] * form.components + c))));
    }
}

template <class Number>
void decode_numbers(const CodedAttribute& form, std::span<const std::byte> coded, std::span<std::byte> values) {
    const std::size_t count = coded.size() / sizeof(Number);
    const std::uint32_t most = (1U << form.bits) - 1;
    for (std::size_t c = 0; c < form.components; ++c) {
        const CodedRange range(form, c);
        for (std::size_t i = c; i < count; i += form.components) {
            const std::uint32_t number = number_at<Number>(coded, i);
            if (number > most)
                throw InvalidInput("attribute '" + form.name + "' has the number " + std::to_string(number) + " in " +
                                   std::to_string(form.bits) + " bits");
            set_number_at(values, i, range.value(number));
        }
    }
}

void require_finite(const MeshAttribute& attribute) {
    for (std::size_t i = 0; i < attribute.data.size() / sizeof(float); ++i)
        if (!std::isfinite(number_at<float>(attribute.data, i)))
            throw InvalidInput("attribute '" + attribute.name + "' has a value that is not finite");
}

}  // namespace

CodedRange::CodedRange(const CodedAttribute& form, std::size_t component)
    : minimum_(form.minimum[component]),
      extent_(double{form.maximum[component]} - minimum_),
      steps_(static_cast<double>((1U << form.bits) - 1)),
      steps_per_unit_(extent_ > 0.0 ? steps_ / extent_ : 0.0) {}

float CodedRange::value(std::uint32_t number) const {
    return static_cast<float>(minimum_ + number * extent_ / steps_);
}

void require_codable(const CodedAttribute& form) {
    if (!can_be_attribute(form.type, form.components))
        throw InvalidInput("attribute '" + form.name + "' is " + form_of(form.type, form.components) + ", must be " +
                           std::string(attribute_forms));
    if (form.bits < 0 || form.bits > max_attribute_bits || (form.bits != 0 && form.type != ElementType::float32))
        throw InvalidInput("attribute '" + form.name + "' of " + std::string(name_of(form.type)) +
                           " is to be coded with " + std::to_string(form.bits) +
                           " bits, must be 0, or of float32 1 to " + std::to_string(max_attribute_bits));
}

std::vector<std::byte> coded_values(const MeshAttribute& attribute, const CodedAttribute& form,
                                    std::span<const std::uint32_t> vertices) {
    const std::size_t size = form.coded_bytes();
    std::vector<std::byte> coded(vertices.size() * size);
    if (form.bits > 8)
        code_numbers<std::uint16_t>(attribute, form, vertices, coded);
    else if (form.bits > 0)
        code_numbers<std::uint8_t>(attribute, form, vertices, coded);
    else
        for (std::size_t i = 0; i < vertices.size(); ++i)
            std::memcpy(coded.data() + i * size, attribute.data.data() + vertices[i] * size, size);
    return coded;
}

MeshAttribute decoded_values(const CodedAttribute& form, std::span<const std::byte> coded) {
    MeshAttribute attribute{form.name, form.type, form.components, {}};
    attribute.data.resize(coded.size() / form.coded_bytes() * attribute.element_bytes());
    if (form.bits > 8)
        decode_numbers<std::uint16_t>(form, coded, attribute.data);
    else if (form.bits > 0)
        decode_numbers<std::uint8_t>(form, coded, attribute.data);
    else
        std::ranges::copy(coded, attribute.data.begin());
    if (form.type == ElementType::float32) require_finite(attribute);
    return attribute;
}

const MeshAttribute& attribute_of(const Mesh& mesh, const CodedAttribute& form) {
    const auto attribute = std::ranges::find(mesh.attributes, form.name, &MeshAttribute::name);
    if (attribute == mesh.attributes.end() || attribute->type != form.type ||
        attribute->components != form.components ||
        attribute->data.size() != mesh.vertices.size() * attribute->element_bytes())
        throw InvalidInput("the mesh has no attribute '" + form.name + "', " + form_of(form.type, form.components) +
                           " for each vertex");
    require_codable(form);
    return *attribute;
}

}  // namespace meniscus
