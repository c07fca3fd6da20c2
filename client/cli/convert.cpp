// meniscus convert: frames of a recording to files of their own.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "cli/commands.hpp"
#include "cli/distinct_files.hpp"
#include "cli/examples.hpp"
#include "cli/mesh_output.hpp"
#include "cli/options/option_group.hpp"
#include "cli/options/verbosity.hpp"
#include "cli/recording_files.hpp"
#include "formats/atomic_file.hpp"
#include "formats/standard_streams.hpp"
#include "formats/vtk_writer.hpp"
#include "meniscus/error.hpp"
#include "meniscus/names.hpp"

namespace meniscus::cli {
namespace {

constexpr std::string_view particles_name = "vtk";

struct ConvertOptions {
    RecordingSelection recording;
    std::string directory;
    std::optional<MeshFormat> format = MeshFormat::ply;  ///< none: the particles, as VTK
    Verbosity verbosity;

    std::filesystem::path path_of(const formats::RecordedFrame& frame) const {
        if (formats::is_standard_stream(directory)) return directory;
        return frame_path(directory, frame.index, format ? name_of(*format) : particles_name);
    }
};

void write_particles(const std::filesystem::path& path, const formats::RecordedParticles& particles) {
    const std::vector<float> positions = particles.world_positions();
    const std::vector<ParticleArray> arrays = formats::views(particles.arrays);
    ParticleFrame frame;
    frame.arrays = arrays;
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

/// Before any work.
void check_outputs(const ConvertOptions& options, const formats::Recording& recording,
                   const std::vector<formats::RecordedFrame>& frames) {
    if (formats::is_standard_stream(options.directory) && frames.size() > 1)
        throw InvalidInput("standard output takes one frame, not " + std::to_string(frames.size()) +
                           ": choose one by --from and --to");
    DistinctFiles distinct;
    distinct.add_input(recording.path());
    for (const formats::RecordedFrame& frame : frames) distinct.add_output(options.path_of(frame));
}

void convert(const ConvertOptions& options) {
    const formats::Recording recording = options.recording.open();
    const auto frames = recording.frames(options.recording.from, options.recording.to);
    check_outputs(options, recording, frames);
    if (!formats::is_standard_stream(options.directory)) formats::make_directory(options.directory);
    for (const formats::RecordedFrame& frame : frames) {
        const auto path = options.path_of(frame);
        if (!options.format) {
            write_particles(path, recording.particles(frame));
        } else if (frame.mesh) {
            const client::ReceivedFrame mesh = recording.mesh(frame);
            const Surface surface(mesh);
            if (*options.format != MeshFormat::bricks) require_mesh(surface, recording.path());
            write_surface(path, surface, *options.format);
        } else {
            std::cerr << "frame " << frame.index << ": its mesh was not recorded\n";
            continue;
        }
        if (!options.verbosity.quiet) std::cerr << formats::output_name(path) << '\n';
    }
}

}  // namespace

void add_convert(CLI::App& app) {
    auto options = std::make_shared<ConvertOptions>();
    CLI::App& command = *app.add_subcommand("convert", "Write frames of a recording as files of their own");
    options->recording.add_to(command);
    {
        const OptionGroup group(command, files_heading);
        command
            .add_option("-o,--output", options->directory, "Folder for the files; - for one frame to standard output")
            ->required();
        std::vector<std::string> formats(names<MeshFormat>.begin(), names<MeshFormat>.end());
        command
            .add_option_function<std::string>(
                "--format",
                [options](const std::string& name) {
                    options->format = name == particles_name ? std::nullopt : find_by_name<MeshFormat>(name);
                },
                "Of the meshes; vtk: the particles")
            ->check(CLI::IsMember(formats))
            ->default_str(std::string(name_of(MeshFormat::ply)));
    }
    options->verbosity.add_quiet_to(command);
    add_examples(command, {"meniscus convert recordings/SESSION/000001.recording -o meshes",
                           "meniscus convert recordings/SESSION --from 20 --to 39 -o particles --format vtk"});
    command.callback([options] { convert(*options); });
}

}  // namespace meniscus::cli
