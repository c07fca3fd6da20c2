// The figures of `meniscus compare --json`.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "compare/comparison.hpp"

namespace meniscus::cli {

/// cell_size: world units. Without it, figures in cells (distances, lost and gained components) are left out.
nlohmann::ordered_json to_json(const compare::Comparison& comparison, const std::optional<double>& cell_size);

}  // namespace meniscus::cli
