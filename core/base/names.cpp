// The parts that the templates of names.hpp share.
#include "meniscus/names.hpp"

#include "meniscus/error.hpp"

namespace meniscus {

std::string listed(std::span<const std::string_view> names) {
    std::string list;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i > 0) list += i + 1 < names.size() ? ", " : " or ";
        list += names[i];
    }
    return list;
}

void detail::refuse_name(std::string_view name, std::string_view what, std::span<const std::string_view> allowed) {
    throw InvalidInput(std::string(what) + " is '" + std::string(name) + "', must be " + listed(allowed));
}

}  // namespace meniscus
