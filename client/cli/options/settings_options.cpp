#include "cli/options/settings_options.hpp"

#include <CLI/CLI.hpp>

namespace meniscus::cli {

void SettingsOptions::add_to(CLI::App& command) {
    command
        .add_option("--smoothing-length", settings.smoothing_length,
                    "In particle radii; the kernel's support is twice that")
        ->capture_default_str();
    command.add_option("--cell-size", settings.cell_size, "Edge of a finest cell, in particle radii")
        ->capture_default_str();
    command.add_option("--iso", settings.iso, "Field value at the surface")->capture_default_str();
    command.add_option("--field", field, "Function whose iso-surface is the fluid surface")
        ->check(CLI::IsMember({"color", "density"}))
        ->capture_default_str();
    command.add_option("--mode", mode, "Three levels of grid, or the finest cell everywhere")
        ->check(CLI::IsMember({"adaptive", "uniform"}))
        ->capture_default_str();
    command.add_option("--criterion", criterion, "How the level of a base cell is decided")
        ->check(CLI::IsMember({"curvature", "count"}))
        ->capture_default_str();
    command
        .add_option(
            "--tolerance", settings.tolerance,
            "With --criterion curvature: how far the surface may depart from that of the finest cells, in those")
        ->capture_default_str();
    command
        .add_option("--count-threshold", settings.count_threshold,
                    "With --criterion count: particles per base cell that decide about level 3")
        ->capture_default_str();
    command.add_option("--edge-points", edge_points, "How the point on an edge is found")
        ->check(CLI::IsMember({"interpolate", "bisect"}))
        ->capture_default_str();
    command
        .add_option("--bisection-steps", settings.bisection_steps,
                    "With --edge-points bisect: iterations on a finest edge")
        ->capture_default_str();
    command.add_flag("--normals,!--no-normals", settings.normals, "Whether vertices get normals (the default)");
    command.add_option("--domain", domain, "X0 Y0 Z0 X1 Y1 Z1: crops the surface, world units")->expected(6);
}

Settings SettingsOptions::build(double particle_radius) const {
    Settings out = settings;
    out.particle_radius = particle_radius;
    out.field = field == "density" ? Field::density : Field::color;
    out.mode = mode == "uniform" ? Mode::uniform : Mode::adaptive;
    out.criterion = criterion == "count" ? Criterion::count : Criterion::curvature;
    out.edge_points = edge_points == "bisect" ? EdgePoints::bisect : EdgePoints::interpolate;
    if (!domain.empty()) out.domain = Box{{domain[0], domain[1], domain[2]}, {domain[3], domain[4], domain[5]}};
    validate(out);
    return out;
}

}  // namespace meniscus::cli
