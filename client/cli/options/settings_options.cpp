#include "cli/options/settings_options.hpp"

#include <CLI/CLI.hpp>

#include "cli/options/named_option.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cli {
namespace {

/// Gives the choice its parameters, if it is this alternative; else refuses their option, which would change nothing.
template <class Alternative, class Choice>
void fill_in(const Alternative& parameters, const CLI::Option* option, const std::string& choice_flag, Choice& choice) {
    if (auto* chosen = std::get_if<Alternative>(&choice))
        *chosen = parameters;
    else if (option->count() > 0)
        throw InvalidInput(option->get_name() + " needs " + choice_flag + " " + std::string(Alternative::name) +
                           ", but " + choice_flag + " is " + std::string(name_of(choice)));
}

}  // namespace

void SettingsOptions::add_to(CLI::App& command) {
    command
        .add_option("--smoothing-length", settings.smoothing_length,
                    "In particle radii; the kernel's support is twice that")
        ->capture_default_str();
    command.add_option("--cell-size", settings.cell_size, "Edge of a finest cell, in particle radii")
        ->capture_default_str();
    command.add_option("--iso", settings.iso, "Field value at the surface")->capture_default_str();
    add_named_option(command, "--field", settings.field, "Function whose iso-surface is the fluid surface");
    add_named_option(command, "--mode", settings.mode, "Three levels of grid, or the finest cell everywhere");
    add_named_option(command, "--criterion", settings.criterion, "How the level of a base cell is decided");
    tolerance_ =
        command
            .add_option(
                "--tolerance", curvature_.tolerance,
                "With --criterion curvature: how far the surface may depart from that of the finest cells, in those")
            ->capture_default_str();
    count_threshold_ = command
                           .add_option("--count-threshold", count_.threshold,
                                       "With --criterion count: particles per base cell that decide about level 3")
                           ->capture_default_str();
    add_named_option(command, "--edge-points", settings.edge_points, "How the point on an edge is found");
    bisection_steps_ =
        command
            .add_option("--bisection-steps", bisection_.steps, "With --edge-points bisect: iterations on a finest edge")
            ->capture_default_str();
    command.add_flag("--normals,!--no-normals", settings.normals, "Whether vertices get normals (the default)");
    command.add_option("--domain", domain, "X0 Y0 Z0 X1 Y1 Z1: crops the surface, world units")->expected(6);
}

Settings SettingsOptions::build(double particle_radius) const {
    Settings out = settings;
    out.particle_radius = particle_radius;
    fill_in(curvature_, tolerance_, "--criterion", out.criterion);
    fill_in(count_, count_threshold_, "--criterion", out.criterion);
    fill_in(bisection_, bisection_steps_, "--edge-points", out.edge_points);
    if (!domain.empty()) out.domain = Box{{domain[0], domain[1], domain[2]}, {domain[3], domain[4], domain[5]}};
    validate(out);
    return out;
}

}  // namespace meniscus::cli
