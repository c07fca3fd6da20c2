#include "cli/print/settings_json.hpp"

#include <nlohmann/json.hpp>

#include "meniscus/names.hpp"

namespace meniscus::cli {

nlohmann::ordered_json to_json(const Settings& settings) {
    nlohmann::ordered_json out;
    out["particle_radius"] = settings.particle_radius;
    out["cell_size"] = settings.cell_size;
    out["iso"] = settings.iso;
    out["field"] = name_of(settings.field);
    out["smoothness"] = smoothness(settings);
    out["spray"] = name_of(settings.spray);
    out["smoothing_length"] = smoothing_length(settings);
    out["mode"] = name_of(settings.mode);
    out["criterion"] = name_of(settings.criterion);
    out["tolerance"] = tolerance(settings);
    out["count_threshold"] = value_or_default<CountCriterion>(settings.criterion).threshold;
    out["edge_points"] = name_of(settings.edge_points);
    out["bisection_steps"] = value_or_default<Bisection>(settings.edge_points).steps;
    out["normals"] = settings.normals;
    if (settings.domain) out["domain"] = {{"min", settings.domain->min}, {"max", settings.domain->max}};
    if (settings.all_attributes)
        out["attributes"] = "all";
    else
        out["attributes"] = settings.attributes;
    return out;
}

}  // namespace meniscus::cli
