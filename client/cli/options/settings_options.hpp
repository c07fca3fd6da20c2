// The flags that become Settings, shared by the commands that reconstruct.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "meniscus/settings.hpp"

namespace CLI {
class App;
}

namespace meniscus::cli {

/// A preset, and the flags that were given over it.
class SettingsOptions {
public:
    /// All flags but --particle-radius and --attribute.
    void add_to(CLI::App& command);
    void add_attribute_to(CLI::App& command);
    /// Throws InvalidInput for values out of range, for what belongs to another field, and for a parameter of a
    /// criterion, or of a way of finding edge points, that is not the one chosen.
    Settings build(double particle_radius) const;

private:
    void add_surface(CLI::App& command, const Settings& defaults);
    void add_grid(CLI::App& command, const Settings& defaults);

    Preset preset_ = Preset::smooth;
    std::optional<double> cell_size_;
    std::optional<double> iso_;
    std::optional<Field> field_;
    std::optional<std::uint32_t> smoothness_;
    std::optional<Spray> spray_;
    std::optional<double> smoothing_length_;
    std::optional<Mode> mode_;
    std::optional<Criterion> criterion_;
    std::optional<double> tolerance_;
    std::optional<std::uint32_t> count_threshold_;
    std::optional<EdgePoints> edge_points_;
    std::optional<std::uint32_t> bisection_steps_;
    bool normals_ = true;
    std::vector<double> domain_;           ///< empty, or x0 y0 z0 x1 y1 z1
    std::vector<std::string> attributes_;  ///< names, or "all"
};

}  // namespace meniscus::cli
