// meniscus info and meniscus sessions: what a server says about itself.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "cli/commands.hpp"
#include "cli/surfaces.hpp"

namespace meniscus::cli {
namespace {

std::string limit(std::uint64_t value) {
    return value == 0 ? "no limit" : std::to_string(value);
}

void print_info(const std::string& server) {
    const client::ServerInfo info = connect(server).server_info();
    std::cout << "version                " << info.version << '\n'
              << "backend                " << info.backend << " (" << info.backend_reason << ")\n"
              << "device                 " << info.device << '\n'
              << "threads                " << info.threads << '\n'
              << "sessions               " << limit(info.max_sessions) << '\n'
              << "watchers per session   " << limit(info.max_watchers_per_session) << '\n'
              << "particles per frame    " << limit(info.max_particles_per_frame) << '\n'
              << "bytes per session      " << limit(info.max_bytes_per_session) << '\n';
}

void print_sessions(const std::string& server) {
    for (const client::SessionInfo& session : connect(server).sessions())
        std::cout << session.id << "  " << session.frames << " frames, " << session.watchers << " watchers, "
                  << (session.uploading ? "uploading" : "idle") << '\n';
}

void add(CLI::App& app, const char* name, const char* what, void (*print)(const std::string&)) {
    auto server = std::make_shared<std::string>();
    CLI::App& command = *app.add_subcommand(name, what);
    command.add_option("--server", *server, "HOST:PORT")->required();
    command.callback([server, print] { print(*server); });
}

}  // namespace

void add_info(CLI::App& app) {
    add(app, "info", "Describe a server: version, backend, limits", print_info);
}

void add_sessions(CLI::App& app) {
    add(app, "sessions", "List a server's sessions", print_sessions);
}

}  // namespace meniscus::cli
