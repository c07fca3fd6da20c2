#include "cli/statistics_json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

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
    out["vertices"] = s.vertices;
    out["triangles"] = s.triangles;
    const auto& t = s.triangles_by_level;
    out["triangles_by_level"] = {{"level1", t[0]}, {"level2", t[1]}, {"level3", t[2]}, {"crack", t[3]}};
    const auto& b = s.base_cells_by_level;
    out["base_cells_by_level"] = {{"level1", b[0]}, {"level2", b[1]}, {"level3", b[2]}};
    out["field_evaluations"] = s.field_evaluations;
    for (std::size_t i = 0; i < stage_count; ++i)
        out["stage_seconds"][std::string(stage_names[i])] = s.stage_seconds[i];
    out["download_seconds"] = s.download_seconds;
    out["total_seconds"] = s.total_seconds;
    out["first_seconds"] = runs.front().total_seconds;
    out["peak_bytes"] = s.peak_bytes;
    out["device_bytes"] = s.device_bytes;
    out["device_peak_bytes"] = s.device_peak_bytes;
    out["backend"] = s.backend;
    out["threads"] = s.threads;
    out["mesh_sha256"] = mesh_sha256;
    return out;
}

}  // namespace meniscus::cli
