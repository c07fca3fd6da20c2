#include "cli/print/statistics_json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/print/row_json.hpp"
#include "meniscus/attribute_coding.hpp"
#include "meniscus/mesh_hash.hpp"

namespace meniscus::cli {

MeshHashes::MeshHashes(const Mesh& mesh)
    : mesh_sha256(meniscus::mesh_sha256(mesh)), bricks_sha256(meniscus::bricks_sha256(mesh)) {}

const Statistics& median_run(const std::vector<Statistics>& runs) {
    if (runs.size() == 1) return runs.front();
    std::vector<const Statistics*> warm;
    for (std::size_t i = 1; i < runs.size(); ++i) warm.push_back(&runs[i]);
    std::stable_sort(warm.begin(), warm.end(),
                     [](const Statistics* a, const Statistics* b) { return a->total_seconds < b->total_seconds; });
    return *warm[(warm.size() - 1) / 2];
}

nlohmann::ordered_json to_json(const std::vector<Statistics>& runs, const MeshHashes& hashes) {
    nlohmann::ordered_json out = rows_json(median_run(runs));
    out["first_seconds"] = runs.front().total_seconds;
    out["mesh_sha256"] = hashes.mesh_sha256;
    out["bricks_sha256"] = hashes.bricks_sha256;
    return out;
}

nlohmann::ordered_json attributes_json(const Mesh& mesh) {
    const std::vector<AttributeRange> ranges = attribute_ranges(mesh);
    auto out = nlohmann::ordered_json::object();
    for (std::size_t a = 0; a < mesh.attributes.size(); ++a) {
        const MeshAttribute& attribute = mesh.attributes[a];
        nlohmann::ordered_json& figures = out[attribute.name];
        figures = {{"type", name_of(attribute.type)}, {"components", attribute.components}};
        if (ranges.empty()) continue;
        for (std::size_t c = 0; c < attribute.components; ++c) {
            figures["minimum"].push_back(ranges[a].minimum[c]);
            figures["maximum"].push_back(ranges[a].maximum[c]);
        }
    }
    return out;
}

nlohmann::ordered_json to_json(const FileWarning& warning) {
    return {{"code", warning.code}, {"value", warning.value}, {"limit", warning.limit}, {"text", warning.text}};
}

}  // namespace meniscus::cli
