// Flags over a preset: a flag that was not given leaves what the preset says. The parameters of a criterion, and of a
// way of finding edge points, are flags beside that which chooses it.
#include "cli/options/settings_options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>

#include "cli/options/named_option.hpp"
#include "cli/options/option_group.hpp"
#include "formats/containers/array_collector.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cli {
namespace {

constexpr std::string_view every_attribute = "all";

std::string help_of(std::string_view setting) {
    std::string help;
    for_each_row<Settings>([&](const auto& row) {
        if (row.name == setting) help = row.facts.help;
    });
    return help;
}

/// The name that a file has for an array stands for the array's, too.
std::string name_of_array(const std::string& name) {
    const std::string known = formats::array_name(name);
    return known.size() == name.size() ? known : name;  // one that is empty or too long is refused as it is
}

}  // namespace

void SettingsOptions::add_to(CLI::App& command) {
    {
        const OptionGroup group(command, surface_heading);
        add_named_option(command, "--preset", preset_,
                         "A set of settings, over which single flags may be given: smooth; paper, the settings of Du "
                         "and Kanai; splashsurf, its surface without smoothing");
    }
    flags_.add_to(command, preset(preset_, 1.0));
}

void SettingsOptions::add_attribute_to(CLI::App& command) {
    const OptionGroup group(command, surface_heading);
    command.add_option("--attribute", attributes_, help_of("attributes"))->type_name("NAME")->allow_extra_args(false);
}

Settings SettingsOptions::build(double particle_radius) const {
    Settings out = preset(preset_, particle_radius);
    flags_.apply(out);
    out.all_attributes = std::ranges::find(attributes_, every_attribute) != attributes_.end();
    if (out.all_attributes && attributes_.size() > 1)
        throw InvalidInput("--attribute all takes every array: leave the other names out");
    if (!out.all_attributes)
        for (const std::string& name : attributes_) out.attributes.push_back(name_of_array(name));
    validate(out);
    return out;
}

}  // namespace meniscus::cli
