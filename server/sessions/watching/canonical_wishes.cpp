#include "sessions/watching/canonical_wishes.hpp"

#include <algorithm>
#include <string>

namespace meniscus::server {

std::vector<AttributeWish> canonical_wishes(const std::vector<AttributeWish>& wishes, const Settings& settings) {
    std::vector<AttributeWish> canonical;
    if (settings.all_attributes) {  // whatever their names will be
        canonical = wishes;
    } else {
        for (const std::string& name : settings.attributes) {
            auto wish = std::ranges::find(wishes, name, &AttributeWish::name);
            if (wish == wishes.end()) wish = std::ranges::find(wishes, std::string(), &AttributeWish::name);
            if (wish != wishes.end()) canonical.push_back({name, wish->bits});
        }
    }
    std::ranges::sort(canonical);
    return canonical;
}

}  // namespace meniscus::server
