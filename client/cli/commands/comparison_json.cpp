#include "cli/commands/comparison_json.hpp"

#include <nlohmann/json.hpp>

namespace meniscus::cli {
namespace {

using Json = nlohmann::ordered_json;

/// unit: the length that the figures are divided by, world units.
Json figures(const compare::DistanceSummary& distance, double unit) {
    return {
        {"rms", distance.rms / unit}, {"percentile_99", distance.percentile_99 / unit}, {"max", distance.max / unit}};
}

Json distances(const compare::Comparison& comparison, double unit) {
    Json out = figures(comparison.distance(), unit);
    out["a_to_b"] = figures(comparison.a.distance, unit);
    out["b_to_a"] = figures(comparison.b.distance, unit);
    return out;
}

Json describe(const compare::Side& side, const MeshHashes& hashes) {
    const compare::Defects& d = side.defects;
    Json out{{"vertices", side.vertices},
             {"triangles", side.triangles},
             {"components", side.parts.size()},
             {"area", side.area},
             {"samples", side.samples},
             {"closed", d.closed()},
             {"defects",
              {{"repeated_vertices", d.repeated_vertices},
               {"unused_vertices", d.unused_vertices},
               {"degenerate_triangles", d.degenerate_triangles},
               {"unbalanced_edges", d.unbalanced_edges},
               {"crowded_edges", d.crowded_edges},
               {"torn_vertices", d.torn_vertices}}}};
    if (!hashes.mesh_sha256.empty()) {
        out["mesh_sha256"] = hashes.mesh_sha256;
        out["bricks_sha256"] = hashes.bricks_sha256;
    }
    return out;
}

Json missing(const compare::Side& side, double cell_size) {
    Json parts = Json::array();
    for (const compare::Part& part : side.missing(cell_size))
        parts.push_back({{"triangles", part.triangles},
                         {"area", part.area},
                         {"center", part.center},
                         {"cells", part.distance / cell_size}});
    return {{"components", parts.size()}, {"farthest_cells", side.farthest_part() / cell_size}, {"parts", parts}};
}

}  // namespace

Json to_json(const compare::Comparison& comparison, const std::array<MeshHashes, 2>& hashes,
             const std::optional<double>& cell_size) {
    Json out;
    out["a"] = describe(comparison.a, hashes[0]);
    out["b"] = describe(comparison.b, hashes[1]);
    out["triangle_ratio"] = comparison.triangle_ratio();
    out["distance"] = distances(comparison, 1.0);
    if (!cell_size) return out;
    out["cell_size"] = *cell_size;
    out["distance_in_cells"] = distances(comparison, *cell_size);
    out["lost"] = missing(comparison.b, *cell_size);
    out["gained"] = missing(comparison.a, *cell_size);
    return out;
}

}  // namespace meniscus::cli
