// meniscus reconstruct: particle files to mesh files.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands.hpp"
#include "cli/distinct_files.hpp"
#include "cli/examples.hpp"
#include "cli/file_pattern.hpp"
#include "cli/frame_selection.hpp"
#include "cli/listener.hpp"
#include "cli/mesh_output.hpp"
#include "cli/options/named_option.hpp"
#include "cli/options/option_group.hpp"
#include "cli/options/settings_options.hpp"
#include "cli/options/verbosity.hpp"
#include "cli/quantized_positions.hpp"
#include "cli/statistics_json.hpp"
#include "cli/statistics_text.hpp"
#include "cli/surfaces.hpp"
#include "cli/warnings.hpp"
#include "formats/atomic_file.hpp"
#include "formats/particles.hpp"
#include "formats/point_writer.hpp"
#include "formats/standard_streams.hpp"
#include "meniscus/error.hpp"
#include "meniscus/mesh_hash.hpp"
#include "meniscus/reconstructor.hpp"

namespace meniscus::cli {
namespace {

using formats::ParticleFormat;

struct ReconstructOptions {
    std::string in;
    std::optional<ParticleFormat> input_format;
    std::string out;
    std::optional<MeshFormat> format;
    std::string spray_out;
    std::string stats;
    double particle_radius = 0.0;
    SettingsOptions settings;
    SurfacesOptions surfaces;
    PositionEncoding positions = PositionEncoding::float32;
    unsigned repeat = 1;
    FrameSelection selection;
    Verbosity verbosity;
    bool strict = false;
};

/// One frame's files. Empty: not asked for.
struct FrameFiles {
    std::uint64_t number = 0;
    std::filesystem::path in;
    std::filesystem::path out;
    std::filesystem::path spray_out;
};

/// What there is to do, checked before any work.
struct Plan {
    bool sequence = false;
    MeshFormat format = MeshFormat::ply;
    std::vector<FrameFiles> frames;
};

std::vector<FrameFiles> files_of(const ReconstructOptions& options) {
    FilePattern in(options.in);
    FilePattern out(options.out);
    FilePattern spray_out(options.spray_out);
    const bool sequence = in.has_number();
    if (!sequence && options.selection.is_given())
        throw InvalidInput("--start, --end, --step and --skip-missing need {} in IN, which is '" + options.in + "'");
    if (!options.out.empty() && out.has_number() != sequence)
        throw InvalidInput("IN '" + options.in + "' and OUT '" + options.out + "' must both have {} or both not");
    if (!options.spray_out.empty() && spray_out.has_number() != sequence)
        throw InvalidInput("IN '" + options.in + "' and --spray-out '" + options.spray_out +
                           "' must both have {} or both not");
    if (!sequence) return {{0, options.in, options.out, options.spray_out}};
    std::vector<FrameFiles> frames;
    const auto inputs = options.selection.files(in);
    out.pad_like(in);
    spray_out.pad_like(in);
    for (const auto& [number, path] : inputs) frames.push_back({number, path, out.at(number), spray_out.at(number)});
    return frames;
}

void check_files(const ReconstructOptions& options, Plan& plan) {
    DistinctFiles distinct;
    for (const FrameFiles& frame : plan.frames) {
        check_named(frame.in, options.input_format.has_value(), "--input-format", names<ParticleFormat>);
        if (!options.input_format) formats::particle_format_of(frame.in);
        distinct.add_input(frame.in);
    }
    // Those of the sequence that are not among the frames are somebody's input, too.
    if (plan.sequence)
        for (const auto& [number, path] : FilePattern(options.in).match_existing()) distinct.add_input(path);
    for (const FrameFiles& frame : plan.frames) {
        if (!frame.out.empty()) {
            plan.format = check_mesh_path(frame.out, options.format);
            distinct.add_output(frame.out);
        }
        if (!frame.spray_out.empty()) {
            check_points_path(frame.spray_out);
            distinct.add_output(frame.spray_out);
        }
    }
    check_folder(options.stats);
    if (!options.stats.empty()) distinct.add_output(options.stats);
}

Plan make_plan(const ReconstructOptions& options) {
    if (options.out.empty() && options.spray_out.empty() && options.stats.empty())
        throw InvalidInput("nothing to write: give -o OUT, --spray-out FILE.ply, --stats FILE.json or several of them");
    if (options.format && options.out.empty()) throw InvalidInput("--format is that of OUT: give -o OUT");
    Plan plan;
    plan.sequence = FilePattern(options.in).has_number();
    plan.frames = files_of(options);
    check_files(options, plan);
    return plan;
}

void say(const FrameFiles& frame, const Statistics& statistics, bool stages) {
    std::cerr << formats::input_name(frame.in) << ": " << summary(statistics);
    for (const auto& path : {frame.out, frame.spray_out})
        if (!path.empty()) std::cerr << ", " << formats::output_name(path);
    std::cerr << '\n';
    if (stages) std::cerr << stages_text(statistics);
    require_listener();
}

void reconstruct(const ReconstructOptions& options) {
    const Settings settings = options.settings.build(options.particle_radius);
    if (!options.spray_out.empty()) check_spray(settings);
    const Plan plan = make_plan(options);
    nlohmann::ordered_json frames = nlohmann::ordered_json::array();
    std::vector<Statistics> runs;
    Warnings warnings(options.strict);
    std::vector<FileWarning> files(plan.frames.size());  // each is there before its frame is submitted
    const bool each_run =
        options.repeat > 1 && !options.verbosity.quiet && (options.verbosity.verbose || isatty(STDERR_FILENO) != 0);

    const auto handle = [&](const Surface& surface) {
        runs.push_back(surface.statistics());
        if (each_run)
            std::cerr << "run " << runs.size() << " of " << options.repeat << ": " << runs.back().total_seconds
                      << " s\n";
        if (runs.size() < options.repeat) return;
        const std::size_t number = surface.index() / options.repeat;
        const FrameFiles& frame = plan.frames[number];
        const FileWarning& file = files[number];
        if (!frame.out.empty()) write_surface(frame.out, surface, plan.format);
        if (!frame.spray_out.empty()) formats::write_points(frame.spray_out, surface.spray());
        if (!options.stats.empty()) {
            nlohmann::ordered_json figures;
            if (plan.sequence) figures["frame"] = frame.number;
            figures.update(to_json(runs, mesh_sha256(surface.mesh())));
            figures["attributes"] = attributes_json(surface.mesh());
            if (file.faces != 0) figures["warnings"].push_back(to_json(file));
            frames.push_back(std::move(figures));
        }
        const std::string name = formats::input_name(frame.in);
        if (file.faces != 0) warnings.say(name, file);
        warnings.say(name, median_run(runs).warnings);
        if (!options.verbosity.quiet) say(frame, median_run(runs), options.verbosity.verbose);
        runs.clear();
    };

    SurfacesOptions place = options.surfaces;
    place.stream.spray = settings.spray == Spray::points;
    const auto surfaces = place.open(settings, handle);
    for (std::size_t i = 0; i < plan.frames.size(); ++i) {
        const FrameFiles& frame = plan.frames[i];
        const formats::Particles particles = formats::read_particles(frame.in, options.input_format);
        files[i] = {particles.faces, particles.count()};
        try {
            validate(particles.frame(), settings);
        } catch (const InvalidInput& e) {
            throw InvalidInput(formats::input_name(frame.in) + ": " + e.what());
        }
        const std::vector<ParticleArray> arrays = formats::views(particles.arrays);
        ParticleFrame upload = particles.frame();
        upload.arrays = arrays;
        std::optional<QuantizedPositions> quantized;
        if (options.positions == PositionEncoding::uint16) quantized.emplace(upload);
        // Files do not tell their simulation time.
        for (unsigned run = 0; run < options.repeat; ++run) try {
                surfaces->submit(quantized ? quantized->frame() : upload, 0.0);
            } catch (const LimitExceeded& e) {
                // A server's refusal may be that of an earlier frame.
                if (!options.surfaces.server.address.empty()) throw;
                throw LimitExceeded(formats::input_name(frame.in) + ": " + e.what());
            }
    }
    surfaces->finish();
    if (!options.stats.empty()) {
        const nlohmann::ordered_json all = plan.sequence ? nlohmann::ordered_json{{"frames", frames}} : frames.at(0);
        formats::write_file(options.stats, all.dump(2) + "\n");
    }
    warnings.finish();
}

void add_files(CLI::App& command, ReconstructOptions& options) {
    const OptionGroup group(command, files_heading);
    command
        .add_option(
            "IN", options.in,
            "Particles: .vtk (legacy), .ply, or .xyz, .bin, .raw (float32 triples); a sequence with {} or {:03} "
            "for the frame number ({} also finds zero-padded names); - for standard input")
        ->required();
    command.add_option("-o,--output", options.out,
                       "Mesh: .ply, .obj or .bricks; with {} for a sequence; - for standard output");
    add_named_option(command, "--input-format", options.input_format,
                     "Format of IN, whatever its extension; - needs it. xyz: float32 triples");
    add_named_option(command, "--format", options.format, "Format of OUT, whatever its extension; - needs it");
    command.add_option("--spray-out", options.spray_out,
                       "With --spray points: the particles left out of the surface, as PLY; with {} for a sequence");
    command.add_option("--stats", options.stats, "Figures of each frame, as JSON");
}

}  // namespace

void add_reconstruct(CLI::App& app) {
    auto options = std::make_shared<ReconstructOptions>();
    CLI::App& command = *app.add_subcommand("reconstruct", "Reconstruct the surface of particle files");
    add_files(command, *options);
    {
        const OptionGroup group(command, surface_heading);
        command.add_option("-r,--particle-radius", options->particle_radius, "World units")->required();
    }
    options->settings.add_to(command);
    options->settings.add_attribute_to(command);
    options->selection.add_to(command);
    {
        const OptionGroup group(command, place_heading);
        add_named_option(command, "--positions", options->positions,
                         "Encoding of the positions; uint16 is over the frame's bounding box");
        command.add_option("--repeat", options->repeat, "Number of times that each frame is reconstructed")
            ->check(CLI::Range(1U, 1000000U))
            ->capture_default_str();
    }
    options->surfaces.add_to(command);
    {
        const OptionGroup group(command, other_heading);
        add_strict_option(command, options->strict);
    }
    options->verbosity.add_to(command);
    add_examples(command, {"meniscus reconstruct frame.vtk -o surface.ply --particle-radius 0.025",
                           "meniscus reconstruct 'frame_{}.vtk' -o 'mesh_{}.ply' -r 0.025 --cell-size 1 --step 2",
                           "meniscus reconstruct frame.vtk -o surface.ply -r 0.025 --server localhost",
                           "zcat frame.vtk.gz | meniscus reconstruct - --input-format vtk -o - --format ply -r 0.025 | "
                           "meniscus picture - --input-format ply -o surface.png"});
    command.callback([options] { reconstruct(*options); });
}

}  // namespace meniscus::cli
