// The figures of `meniscus compare --json`.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "compare/comparison.hpp"

namespace meniscus::cli {

/// cell_size: world units; without it, what is counted in cells (distances, lost and gained components) is left out.
nlohmann::ordered_json to_json(const compare::Comparison& comparison, const std::optional<double>& cell_size);

}  // namespace meniscus::cli
