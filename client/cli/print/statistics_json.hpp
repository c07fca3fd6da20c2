// The figures of `--stats`.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "cli/print/warnings.hpp"
#include "meniscus/statistics.hpp"

namespace meniscus::cli {

/// The identities of a mesh.
struct MeshHashes {
    MeshHashes() = default;
    /// mesh: as it was reconstructed or received.
    explicit MeshHashes(const Mesh& mesh);

    std::string mesh_sha256;  ///< empty: not asked for
    std::string bricks_sha256;
};

/// One frame's figures. runs: at least one; the first is the cold one. The figures are those of the warm run with the
/// median total (the lower of two in the middle), or of the only run; `first_seconds` is the first run's total.
nlohmann::ordered_json to_json(const std::vector<Statistics>& runs, const MeshHashes& hashes);

/// An entry of a frame's "warnings", as those of its statistics are.
nlohmann::ordered_json to_json(const FileWarning& warning);

/// The warm run with the median time, for tests and tables.
const Statistics& median_run(const std::vector<Statistics>& runs);

/// The mesh's attributes by name: type, components, and the range of each component over the vertices.
nlohmann::ordered_json attributes_json(const Mesh& mesh);

}  // namespace meniscus::cli
