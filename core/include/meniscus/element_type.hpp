// The numbers that arrays of particles and attributes of vertices consist of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace meniscus {

enum class ElementType : std::uint8_t { float32, uint8, int32, uint32 };
constexpr std::string_view name_of(ElementType type) {
    switch (type) {
        case ElementType::float32:
            return "float32";
        case ElementType::uint8:
            return "uint8";
        case ElementType::int32:
            return "int32";
        case ElementType::uint32:
            return "uint32";
    }
    return {};
}

/// Size of a number, bytes.
constexpr std::size_t size_of(ElementType type) {
    return type == ElementType::uint8 ? 1 : 4;
}

/// Whether values are names rather than amounts: never averaged.
constexpr bool is_id(ElementType type) {
    return type == ElementType::int32 || type == ElementType::uint32;
}

/// Whether vertices can have an array of this form: float32 or uint8 of 1, 3 or 4 components, or an id.
constexpr bool can_be_attribute(ElementType type, std::size_t components) {
    return components == 1 || (!is_id(type) && (components == 3 || components == 4));
}

}  // namespace meniscus
