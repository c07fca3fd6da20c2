// meniscus compare: the distance of two meshes, and the components that only one of them has.
#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands.hpp"
#include "cli/comparison_json.hpp"
#include "cli/mesh_output.hpp"
#include "formats/atomic_file.hpp"
#include "formats/mesh_file.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cli {
namespace {

constexpr std::size_t most_samples = 100'000'000;

struct CompareOptions {
    std::string a;
    std::string b;
    std::string json;
    std::size_t samples = 200'000;
    std::optional<double> cell_size;  ///< world units
};

compare::SurfaceView view(const formats::TriangleMesh& mesh) {
    return {mesh.positions, mesh.triangles};
}

formats::TriangleMesh read_surface(const std::string& path) {
    formats::TriangleMesh mesh = formats::read_mesh(path);
    compare::validate(view(mesh), path);
    return mesh;
}

void print_side(const char* name, const std::string& path, const compare::Side& side) {
    std::cout << name << path << ": " << side.triangles << " triangles, " << side.vertices << " vertices, "
              << side.parts.size() << " components, "
              << (side.defects.closed() ? "closed" : "NOT CLOSED: " + side.defects.text()) << '\n';
}

void print_distance(const char* name, const compare::DistanceSummary& distance,
                    const std::optional<double>& cell_size) {
    const auto print_figure = [&](const char* label, double value) {
        std::cout << label << value;
        if (cell_size) std::cout << " (" << value / *cell_size << " c)";
    };
    print_figure(name, distance.rms);
    print_figure(", 99 % up to ", distance.percentile_99);
    print_figure(", max ", distance.max);
    std::cout << '\n';
}

/// The components of a side that the other one has nothing for.
void print_missing(const char* name, const compare::Side& side, const char* other, double cell_size) {
    std::cout << name << side.missing(cell_size).size() << " of " << side.parts.size() << " components (farther than "
              << compare::missing_distance << " c from " << other
              << "; the farthest: " << side.farthest_part() / cell_size << " c)\n";
}

void print(const CompareOptions& options, const compare::Comparison& comparison) {
    const auto& cell_size = options.cell_size;
    print_side("A          ", options.a, comparison.a);
    print_side("B          ", options.b, comparison.b);
    std::cout << "triangles  " << comparison.triangle_ratio() << " (A over B)\n";
    print_distance("distance   rms ", comparison.distance(), cell_size);
    print_distance("  A to B   rms ", comparison.a.distance, cell_size);
    print_distance("  B to A   rms ", comparison.b.distance, cell_size);
    if (!cell_size) return;
    print_missing("lost       ", comparison.b, "A", *cell_size);
    print_missing("gained     ", comparison.a, "B", *cell_size);
}

void compare_meshes(const CompareOptions& options) {
    if (options.cell_size && !(*options.cell_size > 0.0 && std::isfinite(*options.cell_size)))
        throw InvalidInput("--cell-size is " + std::to_string(*options.cell_size) + "; it is a positive length");
    check_folder(options.json);
    const formats::TriangleMesh a = read_surface(options.a);
    const formats::TriangleMesh b = read_surface(options.b);
    const compare::Comparison comparison = compare::compare_surfaces(view(a), view(b), options.samples);
    print(options, comparison);
    if (!options.json.empty()) formats::write_file(options.json, to_json(comparison, options.cell_size).dump(2) + "\n");
}

}  // namespace

void add_compare(CLI::App& app) {
    auto options = std::make_shared<CompareOptions>();
    CLI::App& command = *app.add_subcommand(
        "compare", "Measure the two-sided distance of two meshes, and name the components that only one of them has");
    command.add_option("A", options->a, "Mesh: .ply, .obj or .bricks")->required();
    command.add_option("B", options->b, "Mesh that A is held against, such as the same frame's in uniform mode")
        ->required();
    command
        .add_option("--samples", options->samples,
                    "Points on each mesh, spread by area; small components may make them more")
        ->check(CLI::Range(std::size_t{1}, most_samples))
        ->capture_default_str();
    command.add_option("--cell-size", options->cell_size,
                       "Edge of a finest cell, world units: gives distances in cells, and lost and gained components");
    command.add_option("--json", options->json, "The figures, as JSON");
    command.callback([options] { compare_meshes(*options); });
}

}  // namespace meniscus::cli
