// meniscus reconstruct: particle files to mesh files.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands.hpp"
#include "cli/file_pattern.hpp"
#include "cli/mesh_output.hpp"
#include "cli/options/named_option.hpp"
#include "cli/options/settings_options.hpp"
#include "cli/quantized_positions.hpp"
#include "cli/statistics_json.hpp"
#include "cli/surfaces.hpp"
#include "cli/warnings.hpp"
#include "formats/atomic_file.hpp"
#include "formats/particles.hpp"
#include "formats/point_writer.hpp"
#include "meniscus/error.hpp"
#include "meniscus/mesh_hash.hpp"
#include "meniscus/reconstructor.hpp"

namespace meniscus::cli {
namespace {

struct ReconstructOptions {
    std::string in;
    std::string out;
    std::string spray_out;
    std::string stats;
    double particle_radius = 0.0;
    SettingsOptions settings;
    SurfacesOptions surfaces;
    PositionEncoding positions = PositionEncoding::float32;
    unsigned repeat = 1;
    std::optional<std::uint64_t> start;
    std::optional<std::uint64_t> end;
    bool strict = false;
};

/// The frames to read, checked before any work.
struct Input {
    FilePattern in;
    FilePattern out;
    FilePattern spray_out;
    std::uint64_t start = 0;
    std::uint64_t end = 0;

    bool is_sequence() const { return in.has_number(); }
    std::uint64_t count() const { return end - start + 1; }
};

Input check_input(const ReconstructOptions& options) {
    Input input{FilePattern(options.in), FilePattern(options.out), FilePattern(options.spray_out)};
    if (options.out.empty() && options.spray_out.empty() && options.stats.empty())
        throw InvalidInput("nothing to write: give -o OUT, --spray-out FILE.ply, --stats FILE.json or several of them");
    check_folder(options.stats);
    if (input.is_sequence() && !(options.start && options.end))
        throw InvalidInput("IN '" + options.in + "' is a sequence: --start and --end are needed");
    if (!input.is_sequence() && (options.start || options.end))
        throw InvalidInput("--start and --end need {} in IN, which is '" + options.in + "'");
    if (!options.out.empty() && input.out.has_number() != input.is_sequence())
        throw InvalidInput("IN '" + options.in + "' and OUT '" + options.out + "' must both have {} or both not");
    if (!options.spray_out.empty() && input.spray_out.has_number() != input.is_sequence())
        throw InvalidInput("IN '" + options.in + "' and --spray-out '" + options.spray_out +
                           "' must both have {} or both not");
    if (!input.is_sequence()) {
        if (!options.out.empty()) check_mesh_path(options.out);
        if (!options.spray_out.empty()) check_points_path(options.spray_out);
        return input;
    }
    input.start = *options.start;
    input.end = *options.end;
    if (input.start > input.end)
        throw InvalidInput("--start " + std::to_string(input.start) + " is beyond --end " + std::to_string(input.end));
    input.in.match_existing(input.start);
    input.out.pad_like(input.in);
    input.spray_out.pad_like(input.in);
    for (std::uint64_t frame = input.start;; ++frame) {
        if (!std::filesystem::exists(input.in.at(frame)))
            throw InvalidInput(input.in.at(frame).string() + ": no such file (frame " + std::to_string(frame) + " of " +
                               std::to_string(input.start) + " to " + std::to_string(input.end) + ")");
        if (frame == input.end) break;
    }
    if (!options.out.empty()) check_mesh_path(input.out.at(input.start));
    if (!options.spray_out.empty()) check_points_path(input.spray_out.at(input.start));
    return input;
}

void print_progress(const std::string& name, const Statistics& s) {
    std::cerr << name << ": " << s.particles << " particles, " << s.triangles << " triangles, " << s.total_seconds
              << " s\n";
}

void reconstruct(const ReconstructOptions& options) {
    const Settings settings = options.settings.build(options.particle_radius);
    const Input input = check_input(options);
    if (!options.spray_out.empty()) check_spray(settings);
    nlohmann::ordered_json frames = nlohmann::ordered_json::array();
    std::vector<Statistics> runs;
    const bool interactive = isatty(STDERR_FILENO) != 0;
    Warnings warnings(options.strict);
    std::vector<FileWarning> files(input.count());  // each is there before its frame is submitted

    const auto handle = [&](const Surface& surface) {
        runs.push_back(surface.statistics());
        if (options.repeat > 1 && interactive)
            std::cerr << "run " << runs.size() << " of " << options.repeat << ": " << runs.back().total_seconds
                      << " s\n";
        if (runs.size() < options.repeat) return;
        const std::uint64_t frame = input.start + surface.index() / options.repeat;
        const FileWarning& file = files[frame - input.start];
        if (!options.out.empty()) write_surface(input.out.at(frame), surface);
        if (!options.spray_out.empty()) formats::write_points(input.spray_out.at(frame), surface.spray());
        if (!options.stats.empty()) {
            nlohmann::ordered_json figures;
            if (input.is_sequence()) figures["frame"] = frame;
            figures.update(to_json(runs, mesh_sha256(surface.mesh())));
            if (file.faces != 0) figures["warnings"].push_back(to_json(file));
            frames.push_back(std::move(figures));
        }
        if (file.faces != 0) warnings.say(input.in.at(frame).string(), file);
        warnings.say(input.in.at(frame).string(), median_run(runs).warnings);
        if (input.is_sequence() || interactive) print_progress(input.in.at(frame).string(), median_run(runs));
        runs.clear();
    };

    SurfacesOptions place = options.surfaces;
    place.stream.spray = settings.spray == Spray::points;
    const auto surfaces = place.open(settings, handle);
    for (std::uint64_t i = 0; i < input.count(); ++i) {
        const std::filesystem::path path = input.in.at(input.start + i);
        const formats::Particles particles = formats::read_particles(path);
        files[i] = {particles.faces, particles.count()};
        try {
            validate(particles.frame(), settings);
        } catch (const InvalidInput& e) {
            throw InvalidInput(path.string() + ": " + e.what());
        }
        std::optional<QuantizedPositions> quantized;
        if (options.positions == PositionEncoding::uint16) quantized.emplace(particles.frame());
        // Files do not tell their simulation time.
        for (unsigned run = 0; run < options.repeat; ++run)
            surfaces->submit(quantized ? quantized->frame() : particles.frame(), 0.0);
    }
    surfaces->finish();
    if (!options.stats.empty()) {
        const nlohmann::ordered_json all =
            input.is_sequence() ? nlohmann::ordered_json{{"frames", frames}} : frames.at(0);
        formats::write_file(options.stats, all.dump(2) + "\n");
    }
    warnings.finish();
}

}  // namespace

void add_reconstruct(CLI::App& app) {
    auto options = std::make_shared<ReconstructOptions>();
    CLI::App& command = *app.add_subcommand("reconstruct", "Reconstruct the surface of particle files");
    command
        .add_option(
            "IN", options->in,
            "Particles: .vtk (legacy), .ply, or .xyz, .bin, .raw (float32 triples); a sequence with {} or {:03} "
            "for the frame number ({} also finds zero-padded names)")
        ->required();
    command.add_option("-o,--output", options->out, "Mesh: .ply, .obj or .bricks; with {} for a sequence");
    command.add_option("--spray-out", options->spray_out,
                       "With --spray points: the particles left out of the surface, as PLY; with {} for a sequence");
    command.add_option("--particle-radius", options->particle_radius, "World units")->required();
    options->settings.add_to(command);
    options->surfaces.add_to(command);
    add_named_option(command, "--positions", options->positions,
                     "Encoding of the positions; uint16 is over the frame's bounding box");
    command.add_option("--start", options->start, "First frame of a sequence");
    command.add_option("--end", options->end, "Last frame of a sequence");
    command.add_option("--repeat", options->repeat, "Number of times that each frame is reconstructed")
        ->check(CLI::Range(1U, 1000000U))
        ->capture_default_str();
    command.add_option("--stats", options->stats, "Figures of each frame, as JSON");
    add_strict_option(command, options->strict);
    command.callback([options] { reconstruct(*options); });
}

}  // namespace meniscus::cli
