// Settings as JSON, by the names of their flags.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "meniscus/settings.hpp"

namespace meniscus::cli {

/// Every key is always there: a parameter of a choice that was not made has its default.
nlohmann::ordered_json to_json(const Settings& settings);

}  // namespace meniscus::cli
