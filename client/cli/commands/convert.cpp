// meniscus convert: frames of a recording to files of their own, and files to other formats.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <set>
#include <system_error>

#include "cli/commands/commands.hpp"
#include "cli/commands/convert_files.hpp"
#include "cli/commands/convert_publication.hpp"
#include "cli/commands/examples.hpp"
#include "cli/options/option_group.hpp"
#include "cli/options/read_limits_option.hpp"
#include "cli/options/verbosity.hpp"
#include "cli/sequence/distinct_files.hpp"
#include "cli/sequence/file_pattern.hpp"
#include "cli/sequence/recording_files.hpp"
#include "cli/surfaces/mesh_edits.hpp"
#include "cli/surfaces/mesh_output.hpp"
#include "formats/bytes/atomic_file.hpp"
#include "formats/bytes/extension.hpp"
#include "formats/bytes/standard_streams.hpp"
#include "formats/particles/particle_file.hpp"
#include "meniscus/client/publication.hpp"
#include "meniscus/error.hpp"
#include "meniscus/names.hpp"

namespace meniscus::cli {
namespace {

using formats::ParticleFormat;

struct ConvertOptions {
    RecordingSelection recording;
    std::optional<Share> share;
    std::string directory;
    std::optional<MeshFormat> format = MeshFormat::ply;  ///< none: the particles
    ParticleFormat particle_format = ParticleFormat::vtk;
    MeshEdits edits;
    Verbosity verbosity;

    std::filesystem::path path_of(const formats::RecordedFrame& frame) const {
        if (formats::is_standard_stream(directory)) return directory;
        return frame_path(directory, frame.index, format ? name_of(*format) : name_of(particle_format));
    }
};

void write_particles(const std::filesystem::path& path, const formats::RecordedParticles& particles,
                     ParticleFormat format) {
    const std::vector<float> positions = particles.world_positions();
    const std::vector<ParticleArray> arrays = formats::views(particles.arrays);
    ParticleFrame frame;
    frame.arrays = arrays;
    frame.positions = positions;
    frame.levels = particles.levels;
    formats::write_particles(path, frame, format);
}

/// Decodes the mesh, and adds the file's name to an error: the decoder does not know it.
void require_mesh(const Surface& surface, const std::filesystem::path& recording) {
    try {
        surface.mesh();
    } catch (const InvalidInput& error) {
        throw InvalidInput(recording.string() + ": mesh of frame " + std::to_string(surface.index()) + ": " +
                           error.what());
    }
}

/// Checks the output files before any work.
void check_outputs(const ConvertOptions& options, const formats::Recording& recording,
                   const std::vector<formats::RecordedFrame>& frames) {
    if (formats::is_standard_stream(options.directory) && frames.size() > 1)
        throw InvalidInput("standard output takes one frame, not " + std::to_string(frames.size()) +
                           ": choose one by --from and --to");
    DistinctFiles distinct;
    distinct.add_input(recording.path());
    for (const formats::RecordedFrame& frame : frames) distinct.add_output(options.path_of(frame));
}

void convert_recording(const ConvertOptions& options) {
    const formats::Recording recording = options.recording.open();
    auto frames = recording.frames(options.recording.from, options.recording.to);
    check_outputs(options, recording, frames);
    if (options.share) options.share->keep(frames);
    if (!formats::is_standard_stream(options.directory)) formats::make_directory(options.directory);
    for (const formats::RecordedFrame& frame : frames) {
        const auto path = options.path_of(frame);
        if (!options.format) {
            write_particles(path, recording.particles(frame), options.particle_format);
        } else if (frame.mesh) {
            const client::ReceivedFrame mesh = recording.mesh(frame);
            Surface surface(mesh);
            if (*options.format != MeshFormat::bricks) require_mesh(surface, recording.path());
            MeshOutput(surface, *options.format, options.edits).write(path);
        } else {
            std::cerr << "frame " << frame.index << ": its mesh was not recorded\n";
            continue;
        }
        if (!options.verbosity.quiet) std::cerr << formats::output_name(path) << '\n';
    }
}

/// The command's flags, before it is known what IN is.
struct ConvertFlags {
    FileConversion files;
    RecordingSelection recording;
    bool particles = false;
    bool mesh = false;
};

/// A recording or a publication is many frames: OUT is a folder, unless it was written as if it were a file, or a
/// sequence of files.
void require_folder(const std::string& in, const std::string& out) {
    std::error_code error;
    const std::string extension = formats::lower_extension(out);
    const std::string format = extension.empty() ? extension : extension.substr(1);
    const bool sequence = FilePattern(out).has_number();
    if (!sequence && (!find_by_name<MeshFormat>(format) || std::filesystem::is_directory(out, error))) return;
    throw InvalidInput(in + " is a " + (client::is_publication(in) ? "publication" : "recording") +
                       ": OUT is a folder, in which each frame gets its file, not '" + out + "'; say -o FOLDER" +
                       (find_by_name<MeshFormat>(format) ? " --format " + format : ""));
}

/// A recording has both. Without a flag, vtk are its particles.
ConvertOptions recording_options(const ConvertFlags& flags) {
    require_folder(flags.files.in, flags.files.out);
    if (flags.files.selection.is_given() || flags.files.input_format)
        throw InvalidInput(flags.files.in +
                           " is a recording: its frames are chosen by --from and --to, and it has one format");
    ConvertOptions options;
    options.recording = flags.recording;
    options.recording.path = flags.files.in;
    options.share = flags.files.share;
    options.directory = flags.files.out;
    options.verbosity = flags.files.verbosity;
    const auto& format = flags.files.format;
    if (flags.particles || (!flags.mesh && format == name_of(ParticleFormat::vtk))) {
        options.format.reset();
        if (format) options.particle_format = written_particle_format(*format);
    } else if (format) {
        options.format = find_by_name<MeshFormat>(*format);
    }
    options.edits.without_levels = flags.files.without_levels;
    if (options.format) options.edits.require(*options.format);
    return options;
}

PublicationConversion publication_options(const ConvertFlags& flags) {
    require_folder(flags.files.in, flags.files.out);
    if (flags.particles) throw InvalidInput(flags.files.in + " is a publication, which has meshes and no particles");
    if (flags.files.selection.is_given() || flags.files.input_format)
        throw InvalidInput(flags.files.in +
                           " is a publication: its frames are chosen by --from and --to, and it has one format");
    PublicationConversion conversion{.publication = flags.files.in,
                                     .out = flags.files.out,
                                     .range = {flags.recording.from, flags.recording.to, flags.files.share},
                                     .quiet = flags.files.verbosity.quiet};
    if (flags.files.format) conversion.format = *find_by_name<MeshFormat>(*flags.files.format);
    conversion.edits.without_levels = flags.files.without_levels;
    conversion.edits.require(conversion.format);
    return conversion;
}

void convert(const ConvertFlags& flags) {
    if (client::is_publication(flags.files.in)) return convert_publication(publication_options(flags));
    if (is_recording(flags.files.in)) return convert_recording(recording_options(flags));
    if (flags.recording.is_range_given())
        throw InvalidInput(flags.files.in + " is no recording: frames of a sequence are chosen by --start and --end");
    FileConversion files = flags.files;
    if (flags.particles) files.content = FileContent::particles;
    if (flags.mesh) files.content = FileContent::mesh;
    convert_files(files);
}

std::vector<std::string> read_formats() {
    std::set<std::string> all(formats::read_mesh_formats().begin(), formats::read_mesh_formats().end());
    all.insert(names<ParticleFormat>.begin(), names<ParticleFormat>.end());
    return {all.begin(), all.end()};
}

/// Particles are written in no other.
std::vector<std::string> written_formats() {
    return {names<MeshFormat>.begin(), names<MeshFormat>.end()};
}

}  // namespace

void add_convert(CLI::App& app) {
    auto flags = std::make_shared<ConvertFlags>();
    FileConversion& files = flags->files;
    CLI::App& command = *app.add_subcommand(
        "convert",
        "Write frames of a recording or a publication as files of their own, or particle and mesh files in other "
        "formats");
    {
        const OptionGroup group(command, files_heading);
        command
            .add_option(
                "IN", files.in,
                "A recording, or a session's folder if it holds one only; a publication's folder; particles or a "
                "mesh; a sequence of those with {}; - for standard input")
            ->required();
        command
            .add_option("-o,--output", files.out,
                        "File, with {} for a sequence; of a recording or a publication a folder; - for standard output")
            ->required();
        command
            .add_option("--format", files.format,
                        "Format of OUT, whatever its extension; - needs it. Of a recording: "
                        "that of the meshes (default ply), or vtk, its particles")
            ->check(CLI::IsMember(written_formats()));
        command.add_option("--input-format", files.input_format, "Format of IN, whatever its extension; - needs it")
            ->check(CLI::IsMember(read_formats()));
        auto* particles = command.add_flag("--particles", flags->particles,
                                           "Take IN for particles; without this, a file with faces is a mesh");
        command.add_flag("--mesh", flags->mesh, "Take IN for a mesh")->excludes(particles);
        add_triangle_levels_flag(command, files.without_levels);
    }
    flags->recording.add_range_to(command);
    add_read_limits(command, files.limits);
    files.selection.add_to(command);
    add_share_option(command, files.share);
    files.verbosity.add_quiet_to(command);
    add_examples(command,
                 {"meniscus convert recordings/SESSION/000001.recording -o meshes",
                  "meniscus convert recordings/SESSION --from 20 --to 39 -o particles --format vtk",
                  "meniscus convert site -o meshes --format obj", "meniscus convert 'frame_{}.vtk' -o 'frame_{}.npz'",
                  "meniscus convert surface.ply -o surface.obj"});
    command.callback([flags] { convert(*flags); });
}

}  // namespace meniscus::cli
