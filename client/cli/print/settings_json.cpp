#include "cli/print/settings_json.hpp"

#include <nlohmann/json.hpp>

#include "cli/print/row_json.hpp"

namespace meniscus::cli {

nlohmann::ordered_json to_json(const Settings& settings) {
    nlohmann::ordered_json out{{"particle_radius", settings.particle_radius}};
    out.update(rows_json(settings));
    if (settings.all_attributes)
        out["attributes"] = "all";
    else
        out["attributes"] = settings.attributes;
    return out;
}

}  // namespace meniscus::cli
