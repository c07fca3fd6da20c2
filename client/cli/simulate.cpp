// meniscus simulate: the example simulator, streaming its frames.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands.hpp"
#include "cli/mesh_output.hpp"
#include "cli/options/named_option.hpp"
#include "cli/options/settings_options.hpp"
#include "cli/quantized_positions.hpp"
#include "cli/statistics_json.hpp"
#include "cli/surfaces.hpp"
#include "cli/warnings.hpp"
#include "formats/atomic_file.hpp"
#include "formats/vtk_writer.hpp"
#include "meniscus/error.hpp"
#include "meniscus/mesh_hash.hpp"
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
    std::string session;
    std::string out;
    MeshFormat format = MeshFormat::ply;
    std::string particles_out;
    std::string stats;
    bool strict = false;
    SettingsOptions settings;
    SurfacesOptions surfaces;
};

/// One frame as it is uploaded.
simulator::LeveledParticles snapshot(const simulator::Simulation& simulation, bool adaptive) {
    std::vector<float> positions = simulation.positions();
    if (!adaptive) return {std::move(positions), {}};
    return simulator::merge_deep_particles(positions, simulation.scene().particle_radius, simulation.scene().tank);
}

void simulate(const SimulateOptions& options) {
    if (!options.session.empty() && options.surfaces.server.address.empty())
        throw InvalidInput("--session '" + options.session + "' needs --server");
    check_folder(options.stats);
    simulator::Simulation simulation(simulator::make_scene(options.scene, options.particles));
    const Settings settings = options.settings.build(static_cast<double>(simulation.scene().particle_radius));
    std::cerr << "particle radius " << settings.particle_radius << '\n';
    for (const std::string& folder : {options.out, options.particles_out})
        if (!folder.empty()) formats::make_directory(folder);

    nlohmann::ordered_json frames = nlohmann::ordered_json::array();
    Warnings warnings(options.strict);
    const auto handle = [&](const Surface& surface) {
        const client::FrameStatistics& s = surface.statistics();
        if (!options.out.empty())
            write_surface(frame_path(options.out, surface.index(), name_of(options.format)), surface);
        if (!options.stats.empty()) {
            nlohmann::ordered_json figures{{"frame", surface.index()}};
            figures.update(to_json({s}, mesh_sha256(surface.mesh())));
            frames.push_back(std::move(figures));
        }
        std::cerr << "frame " << surface.index() << ": " << s.particles << " particles, " << s.triangles
                  << " triangles, " << s.total_seconds << " s\n";
        warnings.say("frame " + std::to_string(surface.index()), s.warnings);
    };
    const std::string session = options.session.empty() ? client::new_session_id() : options.session;
    const auto surfaces = options.surfaces.open(settings, handle, session);
    if (!options.surfaces.server.address.empty()) std::cerr << "session " << session << '\n';
    for (std::uint64_t frame = 0; frame < options.frames; ++frame) {
        simulation.advance(options.frame_seconds);
        const simulator::LeveledParticles particles = snapshot(simulation, options.adaptive);
        ParticleFrame upload;
        upload.positions = particles.positions;
        upload.levels = particles.levels;
        if (!options.particles_out.empty()) formats::write_vtk(frame_path(options.particles_out, frame, "vtk"), upload);
        std::optional<QuantizedPositions> quantized;
        if (options.positions == PositionEncoding::uint16) quantized.emplace(upload);
        surfaces->submit(quantized ? quantized->frame() : upload, simulation.time());
    }
    surfaces->finish();
    if (!options.stats.empty())
        formats::write_file(options.stats, nlohmann::ordered_json{{"frames", frames}}.dump(2) + "\n");
    warnings.finish();
}

}  // namespace

void add_simulate(CLI::App& app) {
    auto options = std::make_shared<SimulateOptions>();
    CLI::App& command = *app.add_subcommand("simulate", "Simulate water and reconstruct its surface frame by frame");
    add_named_option(command, "--scene", options->scene, "What happens");
    command
        .add_option("--particles", options->particles,
                    "Number of particles; the scene's size stays, their radius follows")
        ->capture_default_str();
    command.add_option("--frames", options->frames, "Number of frames")->capture_default_str();
    command.add_option("--frame-seconds", options->frame_seconds, "Simulated time between two frames")
        ->check(CLI::Range(1e-4, 1.0))
        ->capture_default_str();
    command.add_flag("--adaptive", options->adaptive,
                     "Particles of two sizes: groups of eight that are more than four radii below the surface are "
                     "uploaded as one of level 1");
    options->surfaces.add_to(command);
    options->settings.add_to(command);
    add_named_option(command, "--positions", options->positions,
                     "Encoding of the positions; uint16 is over the frame's bounding box");
    command.add_option("--session", options->session,
                       "With --server: UUID of the session to create (default: a new one)");
    command.add_option("--out", options->out, "Folder for the meshes");
    add_named_option(command, "--format", options->format, "Format of the meshes");
    command.add_option("--particles-out", options->particles_out, "Folder for the particles, as VTK");
    command.add_option("--stats", options->stats, "Figures of each frame, as JSON");
    add_strict_option(command, options->strict);
    command.callback([options] { simulate(*options); });
}

}  // namespace meniscus::cli
