// meniscus-bench quality: reconstructions held against shapes that are known, and against each other.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <iostream>
#include <memory>

#include "benchmarks.hpp"
#include "formats/bytes/atomic_file.hpp"
#include "formats/particles/vtk_writer.hpp"
#include "meniscus/error.hpp"
#include "quality/cases.hpp"
#include "quality/levels.hpp"
#include "quality/pictures.hpp"
#include "report.hpp"

namespace meniscus::benchmarks {
namespace {

using namespace quality;

constexpr std::array<std::string_view, 6> parts{"shapes", "groups", "frames", "motion", "levels", "times"};
/// Number of the frame whose height on the lattice matters.
constexpr unsigned calm_frame = 258;

struct QualityOptions {
    std::vector<std::string> parts;
    std::vector<std::string> shapes;
    std::vector<std::string> fields{"color", "density", "smooth"};
    std::vector<std::uint32_t> smoothnesses{5, 6, 7};
    std::vector<std::string> modes{"uniform", "adaptive"};
    Settings settings;
    std::optional<double> tolerance;
    std::string data;
    std::vector<std::string> frames{"40", "100", "258"};
    unsigned runs = 7;
    std::vector<std::string> judged;  ///< LABEL=FOLDER
    std::string particles;
    std::string pictures;
    std::string out = "tests/benchmarks/results";

    bool wants(std::string_view part) const {
        return parts.empty() || std::find(parts.begin(), parts.end(), part) != parts.end();
    }
};

void refuse_unknown_parts(const std::vector<std::string>& wanted) {
    for (const std::string& part : wanted)
        if (std::find(parts.begin(), parts.end(), part) == parts.end())
            throw InvalidInput("--parts is " + part + ", but must be of " + listed(parts));
}

std::vector<Case> make_cases(const QualityOptions& options, const FrameFiles& files) {
    const double radius = options.settings.particle_radius;
    std::vector<Case> cases;
    const auto add = [&](std::vector<Case> more) { std::move(more.begin(), more.end(), std::back_inserter(cases)); };
    if (options.wants("shapes")) add(shape_cases(options.shapes, radius));
    if (options.wants("groups")) add(group_cases(radius));
    const std::vector<unsigned> frames = files.choose(options.frames);
    if (options.wants("frames")) add(frame_cases(files, frames));
    if (!options.wants("motion")) return cases;
    add(motion_cases(radius, options.settings.cell_size));
    add(rest_cases(files, frames, radius));
    return cases;
}

/// Every field, smooth with every smoothness.
std::vector<Settings> make_fields(const QualityOptions& options) {
    std::vector<Settings> all;
    for (const std::string& field : options.fields) {
        Settings settings = options.settings;
        settings.field = by_name<Field>(field, "field");
        settings.criterion = CurvatureCriterion{options.tolerance};
        if (settings.field != Field::smooth) {
            all.push_back(settings);
            continue;
        }
        for (const std::uint32_t smoothness : options.smoothnesses) {
            settings.smoothness = smoothness;
            all.push_back(settings);
        }
    }
    return all;
}

std::vector<Method> make_methods(const QualityOptions& options) {
    std::vector<Method> methods;
    for (const std::string& judged : options.judged) {
        const std::size_t separator = judged.find('=');
        if (separator == std::string::npos) throw InvalidInput("--judge is " + judged + ", but must be LABEL=FOLDER");
        methods.push_back(reading(judged.substr(0, separator), judged.substr(separator + 1), options.settings));
    }
    if (!methods.empty()) return methods;
    for (Settings settings : make_fields(options))
        for (const std::string& mode : options.modes) {
            settings.mode = by_name<Mode>(mode, "mode");
            methods.push_back(reconstructing(settings));
        }
    return methods;
}

void write_particles(const std::vector<Case>& cases, const std::filesystem::path& folder) {
    formats::make_directory(folder);
    for (const Case& c : cases)
        for (const Cloud& cloud : c.clouds) formats::write_vtk(folder / (cloud.name + ".vtk"), cloud.frame());
}

void measure_cases(const QualityOptions& options, const std::vector<Case>& cases, Figures& figures) {
    for (const Method& method : make_methods(options))
        for (const Case& c : cases) {
            std::vector<Surface> surfaces;
            for (const Cloud& cloud : c.clouds) surfaces.push_back(method.surface_of(cloud));
            figures.add(c.subject, method, c.judge(surfaces));
            if (!options.pictures.empty() && c.subject.part == "frames")
                draw_surface(surfaces[0], c.clouds[0], method, options.settings.particle_radius, options.pictures);
        }
}

/// Measures that hold one mode against the other, at the cell size and at twice that.
void measure_modes(const QualityOptions& options, const FrameFiles& files, Figures& figures) {
    std::vector<Cloud> frames;
    for (const unsigned number : files.choose(options.frames)) frames.push_back(files.read(number));
    for (const double factor : {1.0, 2.0}) {
        std::vector<Settings> fields = make_fields(options);
        for (Settings& field : fields) field.cell_size *= factor;
        if (options.wants("levels")) {
            measure_levels(fields, frames, figures);
            if (files.has(calm_frame)) measure_heights_on_lattice(fields, files.read(calm_frame), figures);
        }
        if (options.wants("times")) measure_times(fields, frames, options.runs, figures);
    }
}

void run_quality(const QualityOptions& options) {
    refuse_unknown_parts(options.parts);
    const FrameFiles files(options.data);
    const std::vector<Case> cases = make_cases(options, files);
    if (!options.particles.empty()) {
        write_particles(cases, options.particles);
        return;
    }
    Figures figures;
    measure_cases(options, cases, figures);
    if (options.judged.empty()) measure_modes(options, files, figures);
    std::cout << figures.text();
    nlohmann::ordered_json summary;
    summary["particle_radius"] = options.settings.particle_radius;
    summary["cell_size"] = options.settings.cell_size;
    summary["iso"] = options.settings.iso;
    write_report(options.out, "quality", summary, figures.rows());
}

}  // namespace

void add_quality(CLI::App& app) {
    auto options = std::make_shared<QualityOptions>();
    options->settings.particle_radius = 0.025;
    CLI::App& command = *app.add_subcommand(
        "quality", "How near surfaces are to known shapes, how smooth, and how still: as CSV and as tables");
    command.add_option("--parts", options->parts, "Of " + listed(parts))->default_str("all")->expected(1, -1);
    command.add_option("--shapes", options->shapes, "Names of shapes")->default_str("all")->expected(1, -1);
    command.add_option("--field", options->fields, "Any of " + listed(names<Field>))
        ->capture_default_str()
        ->expected(1, -1);
    command.add_option("--smoothness", options->smoothnesses, "With field smooth: any of 5, 6, 7")
        ->capture_default_str()
        ->expected(1, -1);
    command.add_option("--mode", options->modes, "Any of " + listed(names<Mode>))
        ->capture_default_str()
        ->expected(1, -1);
    command.add_option("--cell-size", options->settings.cell_size, "In particle radii")->capture_default_str();
    command.add_option("--iso", options->settings.iso, "Field value at the surface")->capture_default_str();
    command.add_option("--tolerance", options->tolerance, "Of the curvature criterion, in cells")
        ->default_str("that of the field");
    command.add_option("--write-particles", options->particles,
                       "Folder for the particles, as VTK; nothing else is done");
    command
        .add_option(
            "--judge", options->judged,
            "LABEL=FOLDER: in place of reconstructions, the meshes in FOLDER, each a PLY of its particles' name")
        ->expected(1, -1);
    command.add_option("--pictures", options->pictures, "Folder for pictures of the real frames");
    command.add_option("--data", options->data, "Folder with frame_NNN.vtk below it")
        ->default_str("that of the environment's MENISCUS_DATA; without it, no real frames");
    command.add_option("--frames", options->frames, "Numbers of real frames, even, odd")
        ->capture_default_str()
        ->expected(1, -1);
    command.add_option("--runs", options->runs, "Runs of each frame, of whose times the median counts")
        ->check(CLI::Range(1U, 1000U))
        ->capture_default_str();
    command.add_option("--out", options->out, "Folder for the results")->capture_default_str();
    command.callback([options] { run_quality(*options); });
}

}  // namespace meniscus::benchmarks
