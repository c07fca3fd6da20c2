// The flags that become Settings, shared by the commands that reconstruct.
#pragma once

#include <vector>

#include "meniscus/settings.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

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
    /// The parameters of every alternative, whichever is chosen.
    CurvatureCriterion curvature_;
    CountCriterion count_;
    Bisection bisection_;
    const CLI::Option* tolerance_ = nullptr;
    const CLI::Option* count_threshold_ = nullptr;
    const CLI::Option* bisection_steps_ = nullptr;
};

}  // namespace meniscus::cli
