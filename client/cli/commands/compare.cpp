// meniscus compare: the distance of two meshes, and the components that only one of them has.
#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands/commands.hpp"
#include "cli/commands/comparison_json.hpp"
#include "cli/commands/examples.hpp"
#include "cli/options/named_option.hpp"
#include "cli/options/option_group.hpp"
#include "cli/options/read_limits_option.hpp"
#include "cli/print/statistics_json.hpp"
#include "cli/sequence/distinct_files.hpp"
#include "cli/surfaces/mesh_output.hpp"
#include "formats/bytes/atomic_file.hpp"
#include "formats/bytes/standard_streams.hpp"
#include "formats/meshes/mesh_file.hpp"
#include "formats/recordings/brick_file.hpp"
#include "meniscus/error.hpp"
#include "meniscus/settings.hpp"

namespace meniscus::cli {
namespace {

constexpr std::size_t most_samples = 100'000'000;

struct CompareOptions {
    std::string a;
    std::string b;
    std::optional<MeshFormat> input_format;  ///< of the mesh that is "-", or of both
    formats::ReadLimits limits;
    std::string json;
    std::size_t samples = 200'000;
    std::optional<double> particle_radius;  ///< world units
    std::optional<double> cell_size;        ///< particle radii

    bool read_standard_input() const { return formats::is_standard_stream(a) || formats::is_standard_stream(b); }
    std::optional<MeshFormat> format_of(const std::string& path) const {
        return read_standard_input() && !formats::is_standard_stream(path) ? std::nullopt : input_format;
    }
};

/// Edge of a finest cell, world units. None: figures are not in cells. Throws InvalidInput if a length is none.
std::optional<double> cell_edge(const CompareOptions& options) {
    const auto require_length = [](const char* flag, double length) {
        if (!(length > 0.0 && std::isfinite(length)))
            throw InvalidInput(std::string(flag) + " is " + std::to_string(length) + "; it is a positive length");
    };
    const double radii = options.cell_size.value_or(Settings{}.cell_size);
    require_length("--cell-size", radii);
    if (!options.particle_radius) {
        if (options.cell_size)
            throw InvalidInput("--cell-size is in particle radii, as that of reconstruct: give --particle-radius, too");
        return std::nullopt;
    }
    require_length("--particle-radius", *options.particle_radius);
    const double edge = *options.particle_radius * radii;
    require_length("--particle-radius times --cell-size", edge);
    return edge;
}

/// The two meshes are named on standard output, unless the figures go there.
std::ostream& out(const CompareOptions& options) {
    return formats::is_standard_stream(options.json) ? std::cerr : std::cout;
}

compare::SurfaceView view(const formats::TriangleMesh& mesh) {
    return {mesh.positions, mesh.triangles};
}

struct ReadSurface {
    formats::TriangleMesh mesh;
    MeshHashes hashes;  ///< of bricks, which alone have the lattice
};

ReadSurface read_surface(const CompareOptions& options, const std::string& path) {
    const std::string name = formats::input_name(path);
    const std::optional<MeshFormat> named = options.format_of(path);
    ReadSurface surface;
    if ((named ? *named : formats::mesh_format_of(path)) == MeshFormat::bricks) {
        const Mesh mesh = formats::read_bricks(name, formats::read_input(path, options.limits.most_bytes)).mesh();
        surface = {formats::to_triangles(mesh), MeshHashes(mesh)};
    } else {
        surface.mesh = formats::read_mesh(path, named, options.limits);
    }
    compare::validate(view(surface.mesh), name);
    return surface;
}

void print_side(std::ostream& text, const char* name, const std::string& path, const compare::Side& side,
                const MeshHashes& hashes) {
    text << name << formats::input_name(path) << ": " << side.triangles << " triangles, " << side.vertices
         << " vertices, " << side.parts.size() << " components, "
         << (side.defects.closed() ? "closed" : "NOT CLOSED: " + side.defects.text()) << '\n';
    if (hashes.mesh_sha256.empty()) return;
    text << "           mesh_sha256 " << hashes.mesh_sha256 << ", bricks_sha256 " << hashes.bricks_sha256 << '\n';
}

void print_distance(std::ostream& text, const char* name, const compare::DistanceSummary& distance,
                    const std::optional<double>& cell) {
    const auto print_figure = [&](const char* label, double value) {
        text << label << value;
        if (cell) text << " (" << value / *cell << " c)";
    };
    print_figure(name, distance.rms);
    print_figure(", 99 % up to ", distance.percentile_99);
    print_figure(", max ", distance.max);
    text << '\n';
}

/// The components of a side that the other one has nothing for.
void print_missing(std::ostream& text, const char* name, const compare::Side& side, const char* other, double cell) {
    text << name << side.missing(cell).size() << " of " << side.parts.size() << " components (farther than "
         << compare::missing_distance << " c from " << other << "; the farthest: " << side.farthest_part() / cell
         << " c)\n";
}

void print(const CompareOptions& options, const compare::Comparison& comparison,
           const std::array<MeshHashes, 2>& hashes, const std::optional<double>& cell) {
    std::ostream& text = out(options);
    print_side(text, "A          ", options.a, comparison.a, hashes[0]);
    print_side(text, "B          ", options.b, comparison.b, hashes[1]);
    text << "triangles  " << comparison.triangle_ratio() << " (A over B)\n";
    print_distance(text, "distance   rms ", comparison.distance(), cell);
    print_distance(text, "  A to B   rms ", comparison.a.distance, cell);
    print_distance(text, "  B to A   rms ", comparison.b.distance, cell);
    if (!cell) return;
    print_missing(text, "lost       ", comparison.b, "A", *cell);
    print_missing(text, "gained     ", comparison.a, "B", *cell);
}

void check_files(const CompareOptions& options) {
    if (formats::is_standard_stream(options.a) && formats::is_standard_stream(options.b))
        throw InvalidInput("A and B are both '-': standard input holds one mesh");
    DistinctFiles distinct;
    for (const std::string& path : {options.a, options.b}) {
        check_named(path, options.input_format.has_value(), "--input-format", formats::read_mesh_formats());
        distinct.add_input(path);
    }
    if (options.json.empty()) return;
    check_folder(options.json);
    distinct.add_output(options.json);
}

void compare_meshes(const CompareOptions& options) {
    const std::optional<double> cell = cell_edge(options);
    check_files(options);
    const ReadSurface a = read_surface(options, options.a);
    const ReadSurface b = read_surface(options, options.b);
    const compare::Comparison comparison = compare::compare_surfaces(view(a.mesh), view(b.mesh), options.samples);
    const std::array hashes{a.hashes, b.hashes};
    print(options, comparison, hashes, cell);
    if (!options.json.empty()) formats::write_file(options.json, to_json(comparison, hashes, cell).dump(2) + "\n");
}

}  // namespace

void add_compare(CLI::App& app) {
    auto options = std::make_shared<CompareOptions>();
    CLI::App& command = *app.add_subcommand(
        "compare", "Measure the two-sided distance of two meshes, and name the components that only one of them has");
    {
        const OptionGroup group(command, files_heading);
        command.add_option("A", options->a, "Mesh: " + listed(formats::read_mesh_formats()) + "; - for standard input")
            ->required();
        command.add_option("B", options->b, "Mesh that A is held against, such as the same frame's in uniform mode")
            ->required();
        add_named_option(command, "--input-format", options->input_format,
                         "Format of the mesh that is -, which needs it; else of both, whatever their extensions");
        command.add_option("--json", options->json, "The figures, as JSON; - for standard output");
    }
    add_read_limits(command, options->limits);
    const OptionGroup group(command, "Measure");
    command.add_option("-r,--particle-radius", options->particle_radius,
                       "World units: gives distances in finest cells, and lost and gained components");
    command
        .add_option("-c,--cell-size", options->cell_size,
                    "Edge of a finest cell, in particle radii, as for reconstruct")
        ->default_str("0.5");
    command
        .add_option("--samples", options->samples,
                    "Points on each mesh, spread by area; small components may make them more")
        ->check(CLI::Range(std::size_t{1}, most_samples))
        ->capture_default_str();
    add_examples(command, {"meniscus compare adaptive.ply uniform.ply --particle-radius 0.025",
                           "meniscus compare a.ply b.ply -r 0.025 --cell-size 1 --json figures.json"});
    command.callback([options] { compare_meshes(*options); });
}

}  // namespace meniscus::cli
