// The parameters of a criterion are flags beside that which chooses it.
#include "cli/options/settings_options.hpp"

#include <CLI/CLI.hpp>
#include <sstream>

#include "cli/options/named_option.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cli {
namespace {

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
    command
        .add_option("--smoothing-length", settings.smoothing_length,
                    "In particle radii; the kernel's support is twice that")
        ->default_str(text_of(smoothing_length(Settings{})));
    command.add_option("--cell-size", settings.cell_size, "Edge of a finest cell, in particle radii")
        ->capture_default_str();
    command.add_option("--iso", settings.iso, "Field value at the surface")->capture_default_str();
    add_named_option(command, "--field", settings.field, "Function whose iso-surface is the fluid surface");
    add_named_option(command, "--mode", settings.mode, "Three levels of grid, or the finest cell everywhere");
    add_named_option(command, "--criterion", settings.criterion, "How the level of a base cell is decided");
    command
        .add_option(
            "--tolerance", tolerance_,
            "With --criterion curvature: how far the surface may depart from that of the finest cells, in those")
        ->default_str(text_of(tolerance(Settings{})));
    command
        .add_option("--count-threshold", count_threshold_,
                    "With --criterion count: particles per base cell that decide about level 3")
        ->default_str(std::to_string(CountCriterion{}.threshold));
    add_named_option(command, "--edge-points", settings.edge_points, "How the point on an edge is found");
    command.add_option("--bisection-steps", bisection_steps_, "With --edge-points bisect: iterations on a finest edge")
        ->default_str(std::to_string(Bisection{}.steps));
    command.add_flag("--normals,!--no-normals", settings.normals, "Whether vertices get normals (the default)");
    command.add_option("--domain", domain, "X0 Y0 Z0 X1 Y1 Z1: crops the surface, world units")->expected(6);
}

Settings SettingsOptions::build(double particle_radius) const {
    Settings out = settings;
    out.particle_radius = particle_radius;
    fill_in(out.criterion, "--criterion", &CurvatureCriterion::tolerance, tolerance_, "--tolerance");
    fill_in(out.criterion, "--criterion", &CountCriterion::threshold, count_threshold_, "--count-threshold");
    fill_in(out.edge_points, "--edge-points", &Bisection::steps, bisection_steps_, "--bisection-steps");
    if (!domain.empty()) out.domain = Box{{domain[0], domain[1], domain[2]}, {domain[3], domain[4], domain[5]}};
    validate(out);
    return out;
}

}  // namespace meniscus::cli
