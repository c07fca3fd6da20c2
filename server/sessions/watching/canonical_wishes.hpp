// Equal lists for wishes that come to the same, so that their receivers share an encode.
#pragma once

#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/settings.hpp"

namespace meniscus::server {

/// settings: of the session. A wish for what it does not have is left out.
std::vector<AttributeWish> canonical_wishes(const std::vector<AttributeWish>& wishes, const Settings& settings);

}  // namespace meniscus::server
