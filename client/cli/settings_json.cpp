#include "cli/settings_json.hpp"

#include <nlohmann/json.hpp>

namespace meniscus::cli {

nlohmann::ordered_json to_json(const Settings& settings) {
    nlohmann::ordered_json out;
    out["particle_radius"] = settings.particle_radius;
    out["smoothing_length"] = settings.smoothing_length;
    out["cell_size"] = settings.cell_size;
    out["iso"] = settings.iso;
    out["field"] = settings.field == Field::density ? "density" : "color";
    out["mode"] = settings.mode == Mode::uniform ? "uniform" : "adaptive";
    out["criterion"] = settings.criterion == Criterion::count ? "count" : "curvature";
    out["tolerance"] = settings.tolerance;
    out["count_threshold"] = settings.count_threshold;
    out["edge_points"] = settings.edge_points == EdgePoints::bisect ? "bisect" : "interpolate";
    out["bisection_steps"] = settings.bisection_steps;
    out["normals"] = settings.normals;
    if (settings.domain) out["domain"] = {{"min", settings.domain->min}, {"max", settings.domain->max}};
    return out;
}

}  // namespace meniscus::cli
