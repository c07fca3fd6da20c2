// meniscus info: version, backend and limits of a server, or the backend of this process.
#include <CLI/CLI.hpp>
#include <iomanip>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include "cli/commands/commands.hpp"
#include "cli/commands/examples.hpp"
#include "cli/options/server_flags.hpp"
#include "cli/surfaces/surfaces.hpp"
#include "meniscus/reconstructor.hpp"

namespace meniscus::cli {
namespace {

/// Prints the version and the backend of a server or of this process.
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
              << "publishes              " << (info.publishes ? "sessions that ask for it" : "nothing") << '\n'
              << "checks of surfaces     "
              << (info.checks_published ? "those made elsewhere are closed" : "of each brick") << '\n';
    std::string_view heading;
    for_each_row<client::ServerInfo>([&](const auto& row) {
        const auto value = *row.find(info);
        const std::string_view group = row.facts.group;
        if (group.starts_with("of one") && heading.empty()) {
            heading = group;
            std::cout << heading << ":\n";
        }
        constexpr int width = 23;
        const std::string label = (group.empty() ? "" : "  ") + std::string(row.facts.help);
        std::cout << std::left << std::setw(width) << label;
        if (value == 0)
            std::cout << "no limit\n";
        else
            std::cout << value << '\n';
    });
}

void print_this_process(Backend choice) {
    const BackendDescription backend = describe_backend(choice);
    print_backend(std::string(version()), backend.name, backend.reason, backend.device);
}

/// Whether a server that cannot be reached is healthy, it cannot say: one that is full turns this check away, too.
bool is_serving(const ServerFlags& server) {
    try {
        return client::Client(server.address, server.connection()).serving();
    } catch (const client::ServerError& error) {
        throw std::runtime_error(std::string(error.what()) +
                                 "; a server that is full (--max-connections) turns this check away, too: ask "
                                 "/healthz of its HTTP port");
    }
}

/// For a container's health check, which has no token to describe the server with.
void print_health(const ServerFlags& server) {
    if (!is_serving(server)) throw std::runtime_error("the server at " + server.address + " is shutting down");
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
