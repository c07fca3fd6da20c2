// meniscus convert: frames of a recording to files of their own.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "cli/commands.hpp"
#include "cli/mesh_output.hpp"
#include "cli/recording_files.hpp"
#include "formats/atomic_file.hpp"
#include "formats/vtk_writer.hpp"
#include "meniscus/error.hpp"
#include "meniscus/names.hpp"

namespace meniscus::cli {
namespace {

struct ConvertOptions {
    RecordingSelection recording;
    std::string directory;
    std::string format{name_of(MeshFormat::ply)};
};

void write_particles(const std::filesystem::path& path, const formats::RecordedParticles& particles) {
    const std::vector<float> positions = particles.world_positions();
    ParticleFrame frame;
    frame.positions = positions;
    frame.levels = particles.levels;
    formats::write_vtk(path, frame);
}

/// What is wrong with a mesh shows when it is decoded, where nothing is known of the file.
void require_mesh(const Surface& surface, const std::filesystem::path& recording) {
    try {
        surface.mesh();
    } catch (const InvalidInput& error) {
        throw InvalidInput(recording.string() + ": mesh of frame " + std::to_string(surface.index()) + ": " +
                           error.what());
    }
}

void convert(const ConvertOptions& options) {
    const formats::Recording recording = options.recording.open();
    const auto frames = recording.frames(options.recording.from, options.recording.to);
    formats::make_directory(options.directory);
    for (const formats::RecordedFrame& frame : frames) {
        const auto path = frame_path(options.directory, frame.index, options.format);
        if (options.format == "vtk") {
            write_particles(path, recording.particles(frame));
        } else if (frame.mesh) {
            const client::ReceivedFrame mesh = recording.mesh(frame);
            const Surface surface(mesh);
            if (options.format != name_of(MeshFormat::bricks)) require_mesh(surface, recording.path());
            write_surface(path, surface);
        } else {
            std::cerr << "frame " << frame.index << ": its mesh was not recorded\n";
            continue;
        }
        std::cerr << path.string() << '\n';
    }
}

}  // namespace

void add_convert(CLI::App& app) {
    auto options = std::make_shared<ConvertOptions>();
    CLI::App& command = *app.add_subcommand("convert", "Write frames of a recording as files of their own");
    options->recording.add_to(command);
    command.add_option("-o,--output", options->directory, "Folder for the files")->required();
    std::vector<std::string> formats(names<MeshFormat>.begin(), names<MeshFormat>.end());
    formats.emplace_back("vtk");
    command.add_option("--format", options->format, "Of the meshes; vtk: the particles")
        ->check(CLI::IsMember(formats))
        ->capture_default_str();
    command.callback([options] { convert(*options); });
}

}  // namespace meniscus::cli
