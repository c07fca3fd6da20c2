// The name that was probably meant by one that does not exist.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace meniscus {

/// The name that takes the fewest changes to come to, of those that take few; empty if none does. A change is a
/// character more, less, another one, or two swapped.
std::string near_name(std::string_view name, const std::vector<std::string>& names);

/// ", did you mean NAME?" for a name that is near; else "; see " and where the names are listed.
std::string suggestion(const std::string& near, const std::string& list);

}  // namespace meniscus
