// meniscus info: version, backend and limits of a server, or the backend of this process.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "cli/commands/commands.hpp"
#include "cli/commands/examples.hpp"
#include "cli/options/server_flags.hpp"
#include "cli/surfaces/surfaces.hpp"
#include "meniscus/reconstructor.hpp"

namespace meniscus::cli {
namespace {

std::string limit(std::uint64_t value) {
    return value == 0 ? "no limit" : std::to_string(value);
}

std::string seconds_limit(double value) {
    std::ostringstream text;
    text << value;
    return value == 0.0 ? "no limit" : text.str();
}

/// Those of a server and of this process alike.
void print_backend(const std::string& version, const std::string& name, const std::string& reason,
                   const std::string& device) {
    std::cout << "version                " << version << '\n'
              << "backend                " << name << " (" << reason << ")\n"
              << "device                 " << device << '\n';
}

std::string codec_names(const std::vector<std::uint32_t>& numbers) {
    std::string text;
    for (const std::uint32_t number : numbers) {
        const auto codec = codec_by_number(number);
        if (!text.empty()) text += ", ";
        text += codec ? std::string(name_of(*codec)) : "number " + std::to_string(number);
    }
    return text;
}

void print_server(const ServerFlags& server) {
    client::Client client = server.connect();
    const client::ServerInfo info = client.server_info();
    print_backend(info.version, info.backend, info.backend_reason, info.device);
    std::cout << "health                 " << (client.serving() ? "serving" : "shutting down") << '\n'
              << "threads                " << info.threads << '\n'
              << "codecs                 " << codec_names(info.codecs) << '\n'
              << "sessions               " << limit(info.max_sessions) << '\n'
              << "watchers per session   " << limit(info.max_watchers_per_session) << '\n'
              << "  formats of them      " << limit(info.max_formats_per_session) << '\n'
              << "particles per frame    " << limit(info.max_particles_per_frame) << '\n'
              << "work per frame         " << seconds_limit(info.max_frame_work) << '\n'
              << "seconds per frame      " << seconds_limit(info.max_frame_seconds) << '\n'
              << "bytes per session      " << limit(info.max_bytes_per_session) << '\n'
              << "GPU bytes per session  " << limit(info.max_device_bytes_per_session) << '\n'
              << "bytes in flight        " << limit(info.max_bytes_in_flight) << '\n'
              << "frames per second      " << limit(info.max_frames_per_second) << '\n'
              << "chunks per frame       " << limit(info.max_chunks_per_frame) << '\n'
              << "bytes per message      " << info.max_message_bytes << '\n'
              << "idle seconds           " << seconds_limit(info.max_idle_seconds) << '\n'
              << "upload seconds         " << seconds_limit(info.max_upload_seconds) << '\n'
              << "upload bytes/second    " << limit(info.min_upload_bytes_per_second) << '\n'
              << "orphan seconds         " << seconds_limit(info.max_orphan_seconds) << '\n'
              << "bytes of all sessions  " << limit(info.max_total_bytes) << '\n'
              << "  on one GPU           " << limit(info.max_total_device_bytes) << '\n'
              << "idle buffers seconds   " << seconds_limit(info.max_idle_buffers_seconds) << '\n'
              << "connections            " << limit(info.max_connections) << '\n'
              << "  from one address     " << limit(info.max_connections_per_peer) << '\n'
              << "readers of recordings  " << limit(info.max_recording_readers) << '\n'
              << "of one name, or of one address where the server asks for no tokens:\n"
              << "  sessions             " << limit(info.max_sessions_per_name) << '\n'
              << "  watchers per session " << limit(info.max_watchers_per_name) << '\n'
              << "  frames per second    " << limit(info.max_frames_per_second_per_name) << '\n'
              << "  bytes in flight      " << limit(info.max_bytes_in_flight_per_name) << '\n';
}

void print_this_process(Backend choice) {
    const BackendDescription backend = describe_backend(choice);
    print_backend(std::string(version()), backend.name, backend.reason, backend.device);
}

/// For a container's health check, which has no token to describe the server with.
void print_health(const ServerFlags& server) {
    if (!server.connect().serving()) throw std::runtime_error("the server at " + server.address + " is shutting down");
    std::cout << "health                 serving\n";
}

struct InfoOptions {
    ServerFlags server;  ///< no address: this process
    bool health = false;
    Backend backend = Backend::automatic;
};

}  // namespace

void add_info(CLI::App& app) {
    auto options = std::make_shared<InfoOptions>();
    CLI::App& command = *app.add_subcommand("info", "Describe a server, or the backend that this process would use");
    auto* server = options->server.add_to(command, "The server to describe: its version, backend and limits");
    add_backend_option(command, options->backend)->excludes(server);
    command.add_flag("--health", options->health, "Only whether it serves, which needs no token; if not, exit code 1")
        ->needs(server);
    add_examples(command, {"meniscus info", "meniscus info --server localhost"});
    command.callback([options] {
        if (options->server.address.empty())
            print_this_process(options->backend);
        else if (options->health)
            print_health(options->server);
        else
            print_server(options->server);
    });
}

}  // namespace meniscus::cli
