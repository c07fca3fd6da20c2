// meniscus simulate: the example simulator, streaming its frames.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "cli/commands/commands.hpp"
#include "cli/commands/examples.hpp"
#include "cli/options/named_option.hpp"
#include "cli/options/number_range.hpp"
#include "cli/options/option_group.hpp"
#include "cli/options/part_options.hpp"
#include "cli/options/settings_options.hpp"
#include "cli/options/verbosity.hpp"
#include "cli/print/listener.hpp"
#include "cli/print/statistics_json.hpp"
#include "cli/print/statistics_text.hpp"
#include "cli/print/warnings.hpp"
#include "cli/surfaces/dealt_particles.hpp"
#include "cli/surfaces/mesh_output.hpp"
#include "cli/surfaces/quantized_positions.hpp"
#include "cli/surfaces/surfaces.hpp"
#include "formats/bytes/atomic_file.hpp"
#include "formats/particles/vtk_writer.hpp"
#include "meniscus/error.hpp"
#include "simulator/adaptive_levels.hpp"
#include "simulator/simulation.hpp"

namespace meniscus::cli {
namespace {

struct SimulateOptions {
    simulator::SceneKind scene = simulator::SceneKind::dam_break;
    std::size_t particles = 16000;
    std::uint64_t frames = 100;
    double frame_seconds = 0.02;
    bool adaptive = false;
    PositionEncoding positions = PositionEncoding::float32;
    std::string out;
    MeshFormat format = MeshFormat::ply;
    std::string particles_out;
    std::string stats;
    bool strict = false;
    SettingsOptions settings;
    SurfacesOptions surfaces;
    Verbosity verbosity;
};

/// The values that its particles carry.
constexpr std::string_view velocity_name = "velocity";  ///< x y z, m/s
constexpr std::string_view age_name = "age";            ///< seconds since the particle came in

bool wants(const Settings& settings, std::string_view name) {
    return settings.all_attributes || std::ranges::find(settings.attributes, name) != settings.attributes.end();
}

void require_known(const Settings& settings) {
    for (const std::string& name : settings.attributes)
        if (name != velocity_name && name != age_name)
            throw InvalidInput("--attribute " + name + ": the simulator's particles have velocity and age");
}

/// One frame as it is uploaded.
struct Upload {
    simulator::LeveledParticles particles;
    std::vector<float> velocities;  ///< empty where no attribute is made of it
    std::vector<float> ages;        ///< likewise
    std::vector<ParticleArray> arrays;

    Upload(const simulator::Simulation& simulation, bool adaptive, const Settings& settings)
        : particles(adaptive ? simulator::merge_deep_particles(
                                   simulation.positions(), simulation.scene().particle_radius, simulation.scene().tank)
                             : simulator::LeveledParticles{.positions = simulation.positions()}) {
        if (wants(settings, velocity_name)) {
            velocities = particles.merged(simulation.velocities(), 3);
            arrays.push_back({velocity_name, std::as_bytes(std::span(velocities)), ElementType::float32, 3});
        }
        if (wants(settings, age_name)) {
            ages = particles.merged(simulation.ages(), 1);
            arrays.push_back({age_name, std::as_bytes(std::span(ages)), ElementType::float32, 1});
        }
    }

    ParticleFrame frame() const {
        ParticleFrame view;
        view.positions = particles.positions;
        view.levels = particles.levels;
        view.arrays = arrays;
        return view;
    }
};

void require_possible_part(const SimulateOptions& options) {
    const client::StreamOptions& stream = options.surfaces.stream;
    if (stream.parts <= 1) return;
    if (options.positions == PositionEncoding::uint16)
        throw InvalidInput("--positions uint16 is over the box of one process' particles: --parts needs float32");
    if (stream.part != 0 && !(options.out.empty() && options.stats.empty()))
        throw InvalidInput("--out and --stats are of meshes, which come to part 0 alone: leave them out of part " +
                           std::to_string(stream.part));
}

void simulate(const SimulateOptions& options) {
    require_possible_part(options);
    simulator::Simulation simulation(simulator::make_scene(options.scene, options.particles));
    const Settings settings = options.settings.build(static_cast<double>(simulation.scene().particle_radius));
    require_known(settings);
    if (!options.verbosity.quiet) std::cerr << "particle radius " << settings.particle_radius << '\n';
    for (const std::string& folder : {options.out, options.particles_out})
        if (!folder.empty()) formats::make_directory(folder);
    check_folder(options.stats);  // which may be one of those

    nlohmann::ordered_json frames = nlohmann::ordered_json::array();
    Warnings warnings(options.strict);
    const auto handle = [&](Surface& surface) {
        const client::FrameStatistics& s = surface.statistics();
        if (!options.stats.empty()) {
            nlohmann::ordered_json figures{{"frame", surface.index()}};
            figures.update(to_json({s}, MeshHashes(surface.mesh())));
            figures["attributes"] = attributes_json(surface.mesh());
            frames.push_back(std::move(figures));
        }
        if (!options.out.empty())
            write_surface(frame_path(options.out, surface.index(), name_of(options.format)), surface, options.format);
        if (!options.verbosity.quiet) std::cerr << "frame " << surface.index() << ": " << summary(s) << '\n';
        if (options.verbosity.verbose) std::cerr << stages_text(s);
        warnings.say("frame " + std::to_string(surface.index()), s.warnings);
        if (!options.verbosity.quiet) require_listener();
    };
    SurfacesOptions place = options.surfaces;
    place.bricks = options.format == MeshFormat::bricks && !options.out.empty();
    const auto surfaces = place.open(settings, handle);
    if (const std::string session = surfaces->session(); !session.empty() && !options.verbosity.quiet)
        std::cerr << "session " << session << '\n';
    for (std::uint64_t frame = 0; frame < options.frames; ++frame) {
        simulation.advance(options.frame_seconds);
        const Upload made(simulation, options.adaptive, settings);
        const ParticleFrame upload = made.frame();
        if (!options.particles_out.empty()) formats::write_vtk(frame_path(options.particles_out, frame, "vtk"), upload);
        std::optional<QuantizedPositions> quantized;
        if (options.positions == PositionEncoding::uint16) quantized.emplace(upload);
        std::optional<DealtParticles> part;
        if (const auto& stream = options.surfaces.stream; stream.parts > 1)
            part.emplace(upload, stream.part, stream.parts);
        surfaces->submit(part ? part->frame() : quantized ? quantized->frame() : upload, simulation.time());
    }
    surfaces->finish();
    if (!options.stats.empty())
        formats::write_file(options.stats, nlohmann::ordered_json{{"frames", frames}}.dump(2) + "\n");
    warnings.finish();
}

void add_scene(CLI::App& command, SimulateOptions& options) {
    const OptionGroup group(command, "Scene");
    add_named_option(command, "--scene", options.scene, "What happens");
    command
        .add_option("--particles", options.particles,
                    "Number of particles; the scene's size stays, their radius follows")
        ->capture_default_str();
    command.add_option("--frames", options.frames, "Number of frames")->capture_default_str();
    command.add_option("--frame-seconds", options.frame_seconds, "Simulated time between two frames")
        ->check(number_range(1e-4, 1.0))
        ->capture_default_str();
    command.add_flag("--adaptive", options.adaptive,
                     "Particles of two sizes: groups of eight that are more than four radii below the surface are "
                     "uploaded as one of level 1");
}

void add_files(CLI::App& command, SimulateOptions& options) {
    const OptionGroup group(command, files_heading);
    command.add_option("--out", options.out, "Folder for the meshes");
    add_named_option(command, "--format", options.format, "Format of the meshes");
    command.add_option("--particles-out", options.particles_out, "Folder for the particles, as VTK");
    command.add_option("--stats", options.stats, "Figures of each frame, as JSON");
}

}  // namespace

void add_simulate(CLI::App& app) {
    auto options = std::make_shared<SimulateOptions>();
    CLI::App& command = *app.add_subcommand("simulate", "Simulate water and reconstruct its surface frame by frame");
    add_scene(command, *options);
    add_files(command, *options);
    options->settings.add_to(command);
    options->settings.add_attribute_to(command);
    {
        const OptionGroup group(command, other_heading);
        add_strict_option(command, options->strict);
    }
    {
        const OptionGroup group(command, place_heading);
        add_named_option(command, "--positions", options->positions,
                         "Encoding of the positions; uint16 is over the frame's bounding box");
    }
    options->surfaces.add_to(command);
    {
        const OptionGroup group(command, place_heading);
        add_part_options(command, options->surfaces.stream, *command.get_option("--server"),
                         command.get_option("--session"));
    }
    options->verbosity.add_to(command);
    add_examples(command,
                 {"meniscus simulate --particles 16000 --frames 100 --out meshes",
                  "meniscus simulate --scene double-dam-break --frames 2000 --server localhost --attribute velocity"});
    command.callback([options] { simulate(*options); });
}

}  // namespace meniscus::cli
