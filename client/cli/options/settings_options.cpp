// Flags over a preset: a flag that was not given leaves what the preset says. The parameters of a criterion, and of a
// way of finding edge points, are flags beside that which chooses it.
#include "cli/options/settings_options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>
#include <string_view>

#include "cli/options/named_option.hpp"
#include "cli/options/option_group.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cli {
namespace {

constexpr std::string_view every_attribute = "all";

template <class Setting, class Value>
void set_if_given(Setting& setting, const std::optional<Value>& given) {
    if (given) setting = *given;
}

/// An alternative that is chosen already keeps its parameters.
template <class Choice>
void choose_if_given(Choice& choice, const std::optional<Choice>& given) {
    if (given && given->index() != choice.index()) choice = *given;
}

/// Gives the alternative its parameter, if the flag was given; refuses a flag that would change nothing.
template <class Alternative, class Choice, class Parameter, class Value>
void fill_in(Choice& choice, const char* choice_flag, Parameter Alternative::*parameter,
             const std::optional<Value>& given, const char* flag) {
    if (!given) return;
    auto* const chosen = std::get_if<Alternative>(&choice);
    if (chosen == nullptr)
        throw InvalidInput(std::string(flag) + " needs " + choice_flag + " " + std::string(Alternative::name) +
                           ", but " + choice_flag + " is " + std::string(name_of(choice)));
    chosen->*parameter = *given;
}

/// As CLI11 shows the defaults of other numbers.
std::string text_of(double value) {
    std::ostringstream out;
    out << value;
    return out.str();
}

}  // namespace

void SettingsOptions::add_to(CLI::App& command) {
    const Settings defaults = preset(preset_, 1.0);
    add_surface(command, defaults);
    add_grid(command, defaults);
}

void SettingsOptions::add_surface(CLI::App& command, const Settings& defaults) {
    const OptionGroup group(command, surface_heading);
    add_named_option(command, "--preset", preset_,
                     "A set of settings, over which single flags may be given: smooth; paper, the settings of Du and "
                     "Kanai; splashsurf, its surface without smoothing");
    command.add_option("-c,--cell-size", cell_size_, "Edge of a finest cell, in particle radii")
        ->default_str(text_of(defaults.cell_size));
    command.add_option("-t,--iso", iso_, "Field value at the surface")->default_str(text_of(defaults.iso));
    add_named_option(command, "--field", field_, defaults.field, "Function whose iso-surface is the fluid surface");
    command
        .add_option("--smoothness", smoothness_,
                    "With --field smooth: the widest support in particle radii, 5 to 7; more is smoother and slower")
        ->default_str(std::to_string(smoothness(defaults)));
    add_named_option(command, "--spray", spray_, defaults.spray,
                     "With --field smooth: particles without company become drops (keep), are left out (discard), or "
                     "are left out and listed beside the surface (points)");
    command
        .add_option("-l,--smoothing-length", smoothing_length_,
                    "With --field color or density: in particle radii; the kernel's support is twice that")
        ->default_str(text_of(smoothing_length(defaults)));
    command.add_flag("--normals,!--no-normals", normals_, "Whether vertices get normals (the default)");
    command.add_option("--domain", domain_, "X0 Y0 Z0 X1 Y1 Z1: crops the surface, world units")->expected(6);
}

void SettingsOptions::add_attribute_to(CLI::App& command) {
    const OptionGroup group(command, surface_heading);
    command
        .add_option("--attribute", attributes_,
                    "Array of the particles whose values the vertices get, such as velocity; once for each; all: every "
                    "array that the first frame brings")
        ->type_name("NAME")
        ->allow_extra_args(false);
}

void SettingsOptions::add_grid(CLI::App& command, const Settings& defaults) {
    const OptionGroup group(command, grid_heading);
    add_named_option(command, "--mode", mode_, defaults.mode, "Three levels of grid, or the finest cell everywhere");
    add_named_option(command, "--criterion", criterion_, defaults.criterion, "How the level of a base cell is decided");
    command
        .add_option("--tolerance", tolerance_,
                    "With --criterion curvature: how far the surface may depart from that of the finest cells, in "
                    "those; the default is that of the default field")
        ->default_str(text_of(tolerance(defaults)));
    command
        .add_option("--count-threshold", count_threshold_,
                    "With --criterion count: particles per base cell that decide about level 3")
        ->default_str(std::to_string(CountCriterion{}.threshold));
    add_named_option(command, "--edge-points", edge_points_, defaults.edge_points, "How the point on an edge is found");
    command.add_option("--bisection-steps", bisection_steps_, "With --edge-points bisect: iterations on a finest edge")
        ->default_str(std::to_string(Bisection{}.steps));
}

Settings SettingsOptions::build(double particle_radius) const {
    Settings out = preset(preset_, particle_radius);
    set_if_given(out.cell_size, cell_size_);
    set_if_given(out.iso, iso_);
    set_if_given(out.field, field_);
    set_if_given(out.smoothness, smoothness_);
    set_if_given(out.spray, spray_);
    set_if_given(out.smoothing_length, smoothing_length_);
    set_if_given(out.mode, mode_);
    choose_if_given(out.criterion, criterion_);
    fill_in(out.criterion, "--criterion", &CurvatureCriterion::tolerance, tolerance_, "--tolerance");
    fill_in(out.criterion, "--criterion", &CountCriterion::threshold, count_threshold_, "--count-threshold");
    choose_if_given(out.edge_points, edge_points_);
    fill_in(out.edge_points, "--edge-points", &Bisection::steps, bisection_steps_, "--bisection-steps");
    out.normals = normals_;
    if (!domain_.empty()) out.domain = Box{{domain_[0], domain_[1], domain_[2]}, {domain_[3], domain_[4], domain_[5]}};
    out.all_attributes = std::ranges::find(attributes_, every_attribute) != attributes_.end();
    if (out.all_attributes && attributes_.size() > 1)
        throw InvalidInput("--attribute all takes every array: leave the other names out");
    if (!out.all_attributes) out.attributes = attributes_;
    validate(out);
    return out;
}

}  // namespace meniscus::cli
