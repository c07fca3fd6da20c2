// Equal lists for attributes that come to the same, so that their receivers share an encode.
#pragma once

#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/settings.hpp"

namespace meniscus::server {

/// settings: of the session. An attribute that it does not have is left out.
std::vector<AttributeWish> canonical_attributes(const std::vector<AttributeWish>& attributes, const Settings& settings);

}  // namespace meniscus::server
