// The flags that become Settings, shared by the commands that reconstruct.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cli/options/row_flags.hpp"
#include "meniscus/settings.hpp"

namespace CLI {
class App;
}

namespace meniscus::cli {

/// A preset, and the flags that were given over it.
class SettingsOptions {
public:
    /// Adds all flags but --particle-radius and --attribute.
    void add_to(CLI::App& command);
    void add_attribute_to(CLI::App& command);
    /// In place of that flag. names: of the arrays, or "all".
    void set_attributes(std::vector<std::string> names) { attributes_ = std::move(names); }
    /// Whether a flag asks for another surface than without flags.
    bool any_given() const { return build(1.0) != preset(Preset::smooth, 1.0); }
    /// Throws InvalidInput for values out of range, for what belongs to another field, and for a parameter of a
    /// criterion, or of a way of finding edge points, that is not the one chosen.
    Settings build(double particle_radius) const;

private:
    Preset preset_ = Preset::smooth;
    RowFlags<Settings> flags_;
    std::vector<std::string> attributes_;  ///< names, or "all"
};

}  // namespace meniscus::cli
