#include "cli/print/statistics_json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "meniscus/attribute_coding.hpp"

namespace meniscus::cli {

const Statistics& median_run(const std::vector<Statistics>& runs) {
    if (runs.size() == 1) return runs.front();
    std::vector<const Statistics*> warm;
    for (std::size_t i = 1; i < runs.size(); ++i) warm.push_back(&runs[i]);
    std::stable_sort(warm.begin(), warm.end(),
                     [](const Statistics* a, const Statistics* b) { return a->total_seconds < b->total_seconds; });
    return *warm[(warm.size() - 1) / 2];
}

nlohmann::ordered_json to_json(const std::vector<Statistics>& runs, const std::string& mesh_sha256) {
    const Statistics& s = median_run(runs);
    nlohmann::ordered_json out;
    out["particles"] = s.particles;
    out["spray_particles"] = s.spray_particles;
    out["vertices"] = s.vertices;
    out["triangles"] = s.triangles;
    for (const TriangleLevel level : choices<TriangleLevel>)
        out["triangles_by_level"][std::string(name_of(level))] = s.triangles_by_level[static_cast<std::size_t>(level)];
    for (std::size_t i = 0; i < s.base_cells_by_level.size(); ++i)
        out["base_cells_by_level"][std::string(names<TriangleLevel>[i])] = s.base_cells_by_level[i];
    out["vertices_without_particles"] = s.vertices_without_particles;
    out["volume"] = s.volume;
    out["particle_volume"] = s.particle_volume;
    out["field_evaluations"] = s.field_evaluations;
    for (const Stage stage : choices<Stage>)
        out["stage_seconds"][std::string(name_of(stage))] = s.stage_seconds[static_cast<std::size_t>(stage)];
    out["download_seconds"] = s.download_seconds;
    out["total_seconds"] = s.total_seconds;
    out["first_seconds"] = runs.front().total_seconds;
    out["peak_bytes"] = s.peak_bytes;
    out["device_bytes"] = s.device_bytes;
    out["device_peak_bytes"] = s.device_peak_bytes;
    out["backend"] = s.backend;
    out["threads"] = s.threads;
    out["mesh_sha256"] = mesh_sha256;
    out["warnings"] = nlohmann::ordered_json::array();
    for (const Warning& w : s.warnings)
        out["warnings"].push_back(
            {{"code", name_of(w.code)}, {"value", w.value}, {"limit", w.limit}, {"text", w.text}});
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
