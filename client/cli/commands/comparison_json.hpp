// The figures of `meniscus compare --json`.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "cli/print/statistics_json.hpp"
#include "compare/comparison.hpp"

namespace meniscus::cli {

/// hashes: of A and B, empty where they are not known. cell_size: world units. Without it, figures in cells (distances,
/// lost and gained components) are left out.
nlohmann::ordered_json to_json(const compare::Comparison& comparison, const std::array<MeshHashes, 2>& hashes,
                               const std::optional<double>& cell_size);

}  // namespace meniscus::cli
