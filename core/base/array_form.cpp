#include "meniscus/array_form.hpp"

namespace meniscus {

std::string form_of(ElementType type, std::size_t components) {
    return form_of(name_of(type), components);
}

std::string form_of(std::string_view type, std::size_t components) {
    return std::string(type) + " of " + std::to_string(components) + (components == 1 ? " component" : " components");
}

}  // namespace meniscus
