#include "sessions/watching/canonical_attributes.hpp"

#include <algorithm>
#include <string>

namespace meniscus::server {

std::vector<AttributeWish> canonical_attributes(const std::vector<AttributeWish>& attributes,
                                                const Settings& settings) {
    std::vector<AttributeWish> canonical;
    if (settings.all_attributes) {  // whatever their names will be
        canonical = attributes;
    } else {
        for (const std::string& name : settings.attributes) {
            auto asked = std::ranges::find(attributes, name, &AttributeWish::name);
            if (asked == attributes.end()) asked = std::ranges::find(attributes, std::string(), &AttributeWish::name);
            if (asked != attributes.end()) canonical.push_back({name, asked->bits});
        }
    }
    std::ranges::sort(canonical);
    return canonical;
}

}  // namespace meniscus::server
