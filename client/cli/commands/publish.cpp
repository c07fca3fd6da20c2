// meniscus publish: a surface as plain files, which any web host carries.
#include <CLI/CLI.hpp>
#include <cstdint>
#include <limits>
#include <memory>

#include "cli/commands/commands.hpp"
#include "cli/commands/examples.hpp"
#include "cli/commands/publish_sources.hpp"
#include "cli/options/named_option.hpp"
#include "cli/options/number_range.hpp"
#include "cli/options/option_group.hpp"
#include "cli/options/read_limits_option.hpp"
#include "cli/options/seconds_option.hpp"
#include "cli/options/session_flags.hpp"
#include "cli/sequence/recording_files.hpp"
#include "cli/surfaces/surfaces.hpp"
#include "formats/bytes/extension.hpp"
#include "formats/meshes/mesh_formats.hpp"

namespace meniscus::cli {
namespace {

void publish(const PublishCommand& command) {
    if (!command.server.address.empty()) return publish_session(command);
    if (is_recording(command.source)) return publish_recording(command);
    if (formats::lower_extension(command.source) == row_of(formats::MeshFormat::bricks).extension)
        return publish_bricks(command);
    publish_particles(command);
}

void add_files(CLI::App& app, PublishCommand& command) {
    {
        const OptionGroup group(app, files_heading);
        app.add_option("SOURCE", command.source,
                       "Particles: " + listed(formats::particle_extensions()) +
                           ", .bricks, or a sequence of those with {}; a recording, or a session's folder if it holds "
                           "one only; with --server a session, by its id or its name")
            ->required();
        app.add_option("--to", command.folder,
                       "Folder of the publication; one that is there goes on, also after a run that was killed")
            ->required();
        add_named_option(app, "--input-format", command.input_format,
                         "Format of the particles, whatever their extension");
    }
    add_read_limits(app, command.limits);
    command.selection.add_range_to(app);
    const OptionGroup group(app, sequence_heading);
    app.add_option("--every", command.every, "Frames whose number is a multiple of this")
        ->check(CLI::Range(std::uint64_t{1}, std::numeric_limits<std::uint64_t>::max()).description("POSITIVE"))
        ->capture_default_str();
    app.add_option("--frame-rate", command.frame_rate,
                   "Frames per second, at which files and recordings are shown (default: 25); particle file number N "
                   "then has the time N / RATE in place of 0")
        ->type_name("RATE")
        ->check(number_range(0.001, 1e6).description(""));
    app.add_option("--keep", command.keep, "Seconds of the newest frames that stay (default: all)")
        ->check(number_range(1.0, 1e9));
}

}  // namespace

void add_publish(CLI::App& app) {
    auto options = std::make_shared<PublishCommand>();
    CLI::App& command =
        *app.add_subcommand("publish", "Write a surface as plain files, which any web host, cache or CDN carries");
    add_files(command, *options);
    {
        const OptionGroup group(command, surface_heading);
        command.add_option("-r,--particle-radius", options->particle_radius, "World units; needed for particles");
    }
    options->settings.add_to(command);
    options->form.add_form_to(command, mesh_heading, "entropy", "those of a session or a recording; none of particles");
    {
        const OptionGroup group(command, place_heading);
        add_backend_option(command, options->backend.backend);
        command.add_option("--threads", options->backend.threads, "Worker threads; 0: one per processor")
            ->check(CLI::Range(0U, max_threads))
            ->capture_default_str();
    }
    {
        const OptionGroup group(command, "What people read");
        add_description_flags(command, options->description, "In the manifest: ");
    }
    options->server.add_to(command, "SOURCE is a session of this meniscusd");
    {
        const OptionGroup group(command, server_heading);
        options->form.options.reconnect = std::chrono::seconds(30);
        add_seconds(command, "--reconnect", options->form.options.reconnect,
                    "With --server: seconds for which a broken connection or a restarting server is tried again; 0: no "
                    "retries")
            ->check(number_range(0.0, 1e6))
            ->default_str("30");
    }
    options->verbosity.add_quiet_to(command);
    add_examples(command, {"meniscus publish 'frame_{}.vtk' --to site -r 0.025",
                           "meniscus publish recordings/SESSION --to site --normals-by receiver",
                           "meniscus publish SESSION --server localhost --to /var/www/water --keep 600"});
    command.callback([options] { publish(*options); });
}

}  // namespace meniscus::cli
