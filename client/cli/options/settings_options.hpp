// The flags that become Settings, shared by the commands that reconstruct.
#pragma once

#include <string>
#include <vector>

#include "meniscus/settings.hpp"

namespace CLI {
class App;
}

namespace meniscus::cli {

struct SettingsOptions {
    Settings settings;  ///< numbers are parsed into it; complete only after build()
    std::string field = "color";
    std::string mode = "adaptive";
    std::string criterion = "curvature";
    std::string edge_points = "interpolate";
    std::vector<double> domain;  ///< empty, or x0 y0 z0 x1 y1 z1

    /// All flags but --particle-radius.
    void add_to(CLI::App& command);
    /// Throws InvalidInput for what is out of range.
    Settings build(double particle_radius) const;
};

}  // namespace meniscus::cli
