// meniscus publish: a surface as plain files, which any web host carries.
#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <system_error>

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
#include "cli/surfaces/mesh_output.hpp"
#include "cli/surfaces/surfaces.hpp"
#include "files/publication_format.hpp"
#include "formats/bytes/extension.hpp"
#include "formats/meshes/mesh_formats.hpp"
#include "meniscus/client/publication.hpp"
#include "meniscus/error.hpp"
#include "pages/publication_pages.hpp"

namespace meniscus::cli {
namespace {

/// Browsers open larger pages, and take long for it.
constexpr std::uintmax_t most_page_bytes = 50'000'000;

void publish_source(const PublishCommand& command) {
    if (!command.server.address.empty()) return publish_session(command);
    if (client::is_publication(command.source))
        throw InvalidInput(command.source + " is a publication already: copy its folder");
    if (is_recording(command.source)) return publish_recording(command);
    if (formats::lower_extension(command.source) == row_of(formats::MeshFormat::bricks).extension)
        return publish_bricks(command);
    publish_particles(command);
}

/// Its files alone: the folder has another use where something else is in it.
void remove_publication(const std::filesystem::path& folder) {
    const client::PublicationInfo info = client::Publication(folder).info();
    std::error_code ignored;
    std::filesystem::remove(folder / files::manifest_name, ignored);
    for (const client::PublishedSegment& segment : info.segments)
        std::filesystem::remove(folder / segment.file(), ignored);
    std::filesystem::remove(folder, ignored);
}

void publish(PublishCommand command) {
    command.folder = command.to;
    if (!command.single_file) {
        if (command.page) pages::write_site(command.folder);
        return publish_source(command);
    }
    pages::require_viewer();
    if (!command.server.address.empty())
        throw InvalidInput(
            "--single-file is of frames that are all there, and a session goes on: publish it to a folder");
    check_folder(command.to);
    // Where a run that was killed goes on.
    command.folder += ".parts";
    publish_source(command);
    pages::write_single_page(command.folder, command.to);
    remove_publication(command.folder);
    const std::uintmax_t bytes = std::filesystem::file_size(command.to);
    if (!command.verbosity.quiet) std::cerr << command.to.string() << ": " << bytes << " bytes\n";
    if (bytes > most_page_bytes)
        std::cerr << command.to.string() << ": browsers take long to open a page of more than " << most_page_bytes
                  << " bytes; --normals-by receiver, --position-bits or --every make it smaller\n";
}

void add_files(CLI::App& app, PublishCommand& command) {
    {
        const OptionGroup group(app, files_heading);
        app.add_option("SOURCE", command.source,
                       "Particles: " + listed(formats::particle_extensions()) +
                           ", .bricks, or a sequence of those with {}; a recording, or a session's folder if it holds "
                           "one only; with --server a session, by its id or its name")
            ->required();
        app.add_option("--to", command.to,
                       "Folder of the publication; one that is there goes on, also after a run that was killed. With "
                       "--single-file the page")
            ->required();
        auto* const page = app.add_flag("--page", command.page, "Put the viewer beside it: the folder is a web site");
        app.add_flag("--single-file", command.single_file,
                     "One page with the viewer and all frames, which opens without a server and without a network")
            ->excludes(page);
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
    options->form.add_form_to(command, mesh_heading, "entropy", "");
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
    add_examples(command, {"meniscus publish 'frame_{}.vtk' --to site -r 0.025 --page",
                           "meniscus publish 'frame_{}.vtk' --to water.html -r 0.025 --single-file",
                           "meniscus publish recordings/SESSION --to site --normals-by receiver",
                           "meniscus publish SESSION --server localhost --to /var/www/water --keep 600"});
    command.callback([options] { publish(*options); });
}

}  // namespace meniscus::cli
