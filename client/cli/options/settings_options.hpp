// The flags that become Settings, shared by the commands that reconstruct.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "meniscus/settings.hpp"

namespace CLI {
class App;
}

namespace meniscus::cli {

struct SettingsOptions {
    Settings settings;           ///< parsed into; complete only after build()
    std::vector<double> domain;  ///< empty, or x0 y0 z0 x1 y1 z1

    /// All flags but --particle-radius.
    void add_to(CLI::App& command);
    /// Throws InvalidInput for values out of range, and for a parameter of a criterion, or of a way of finding edge
    /// points, that is not the one chosen.
    Settings build(double particle_radius) const;

private:
    // The parameters of alternatives, where their flags were given.
    std::optional<double> tolerance_;
    std::optional<std::uint32_t> count_threshold_;
    std::optional<std::uint32_t> bisection_steps_;
};

}  // namespace meniscus::cli
