// meniscus watch: the meshes of somebody else's session, as they come.
#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>

#include "cli/commands/commands.hpp"
#include "cli/commands/examples.hpp"
#include "cli/options/named_option.hpp"
#include "cli/options/normals_by.hpp"
#include "cli/options/number_range.hpp"
#include "cli/options/option_group.hpp"
#include "cli/options/seconds_option.hpp"
#include "cli/options/server_flags.hpp"
#include "cli/options/verbosity.hpp"
#include "cli/options/watch_flags.hpp"
#include "cli/print/listener.hpp"
#include "cli/print/warnings.hpp"
#include "cli/surfaces/mesh_output.hpp"
#include "formats/bytes/atomic_file.hpp"
#include "formats/meshes/point_writer.hpp"
#include "meniscus/client/session_lookup.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cli {
namespace {

struct WatchOptions {
    std::string session;
    ServerFlags server;
    std::string directory;
    std::string spray_directory;
    MeshFormat format = MeshFormat::ply;
    std::uint64_t frames = 0;              ///< 0: until the session ends
    std::chrono::milliseconds timeout{0};  ///< without a frame, after which to end; 0: none
    bool strict = false;
    WatchFlags flags;
    Verbosity verbosity;
};

/// None when the session has ended.
std::optional<client::ReceivedFrame> next_frame(client::Watcher& watcher, const WatchOptions& options) {
    if (options.timeout.count() == 0) return watcher.next();
    client::Next<client::ReceivedFrame> next = watcher.next(options.timeout);
    if (next || next.ended) return std::move(next.frame);
    std::ostringstream what;
    what << "no frame of session " << options.session << " has come for " << seconds_of(options.timeout)
         << " s (--timeout)";
    throw client::ServerError(what.str(), client::ErrorCode::deadline_exceeded);
}

void watch(const WatchOptions& options) {
    check_normals_by(options.flags.options.normals_by, options.flags.normal_bits, options.format == MeshFormat::bricks);
    client::Client client = options.server.connect();
    const std::string id = session_id_of(client, options.session);
    client::SessionInfo session;
    try {
        session = client.session(id);
    } catch (const client::ServerError& e) {
        throw InvalidInput("no session '" + options.session + "' at '" + options.server.address + "': " + e.what());
    }
    formats::make_directory(options.directory);
    client::WatchOptions request = options.flags.build(session.settings);
    if (options.format == MeshFormat::bricks && !request.codec) request.codec = Codec::lattice_entropy;
    request.spray = !options.spray_directory.empty() || options.format == MeshFormat::bricks;
    if (!options.spray_directory.empty()) {
        check_spray(session.settings);
        formats::make_directory(options.spray_directory);
        if (options.format == MeshFormat::ply &&
            std::filesystem::equivalent(options.directory, options.spray_directory))
            throw InvalidInput("-o and --spray-out are one folder, '" + options.directory +
                               "', in which a frame's mesh and its spray have one name: name two");
    }
    Warnings warnings(options.strict);
    client::Watcher watcher = client.watch(id, request);
    for (std::uint64_t received = 0; options.frames == 0 || received < options.frames; ++received) {
        const auto frame = next_frame(watcher, options);
        if (!frame) {
            if (const std::string reason = watcher.end_reason(); !reason.empty() && !options.verbosity.quiet)
                std::cerr << "The session has ended: " << reason << "\n";
            break;
        }
        const auto path = frame_path(options.directory, frame->index, name_of(options.format));
        Surface surface(*frame);
        write_surface(path, surface, options.format);
        if (!options.spray_directory.empty())
            formats::write_points(frame_path(options.spray_directory, frame->index, name_of(MeshFormat::ply)),
                                  frame->spray);
        warnings.say(path.string(), frame->statistics.warnings);
        if (options.verbosity.quiet) continue;
        std::uint64_t triangles = 0;
        for (const auto& brick : frame->bricks) triangles += brick->triangles;
        std::cerr << path.string() << ": " << triangles << " triangles, " << frame->changed.size() << " of "
                  << frame->bricks.size() << " bricks new\n";
        require_listener();
    }
    warnings.finish();
}

}  // namespace

void add_watch(CLI::App& app) {
    auto options = std::make_shared<WatchOptions>();
    CLI::App& command = *app.add_subcommand("watch", "Write the meshes of a session as they come");
    {
        const OptionGroup group(command, files_heading);
        command.add_option("SESSION", options->session, "The session's id, or its name if no other session has that")
            ->required();
        command.add_option("-o,--output", options->directory, "Folder for the meshes")->required();
        add_named_option(command, "--format", options->format, "Format of the meshes");
        command.add_option("--spray-out", options->spray_directory,
                           "Folder for the particles left out of the surface, as PLY; of a session with spray points");
        command
            .add_option("--frames", options->frames, "Number of frames after which to end; 0: when the session ends")
            ->capture_default_str();
        add_seconds(command, "--timeout", options->timeout,
                    "Seconds without a frame after which to end, with exit code 1; 0: never")
            ->check(number_range(0.0, 1e6))
            ->default_str("0");
    }
    options->flags.add_to(command);
    options->server.add_to(command, "The server that has the session")->required();
    {
        const OptionGroup group(command, other_heading);
        add_strict_option(command, options->strict);
    }
    options->verbosity.add_quiet_to(command);
    add_examples(command, {"meniscus watch SESSION --server localhost -o meshes",
                           "meniscus watch SESSION --server localhost -o meshes --max-level 2 --bytes-per-second 2MB"});
    command.callback([options] { watch(*options); });
}

}  // namespace meniscus::cli
