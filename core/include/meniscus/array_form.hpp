// The form of an array, as messages name it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "meniscus/element_type.hpp"

namespace meniscus {

/// Such as "float32 of 3 components". components: numbers per particle or vertex.
std::string form_of(ElementType type, std::size_t components);
/// The same for an element type by its name, which core may not know.
std::string form_of(std::string_view type, std::size_t components);

/// The forms of can_be_attribute().
inline constexpr std::string_view attribute_forms = "float32 or uint8 of 1, 3 or 4 components, or int32 or uint32 of 1";

}  // namespace meniscus
