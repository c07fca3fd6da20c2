// meniscus top: a server's sessions, live.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <iostream>
#include <memory>
#include <thread>

#include "cli/commands/commands.hpp"
#include "cli/commands/examples.hpp"
#include "cli/options/number_range.hpp"
#include "cli/options/seconds_option.hpp"
#include "cli/options/server_flags.hpp"
#include "cli/print/session_table.hpp"
#include "cli/print/terminal.hpp"

namespace meniscus::cli {
namespace {

struct TopOptions {
    ServerFlags server;
    std::chrono::milliseconds interval = std::chrono::seconds(1);
    bool once = false;
};

/// Looks twice, since frames per second take two looks.
void print_once(const TopOptions& options) {
    client::Client client = options.server.connect();
    FrameRates rates;
    rates.update(client.sessions(), std::chrono::steady_clock::now());
    std::this_thread::sleep_for(options.interval);
    const auto rows = rates.update(client.sessions(), std::chrono::steady_clock::now());
    if (rows.empty())
        std::cerr << "meniscus: " << options.server.address << " has no sessions\n";
    else
        std::cout << session_table(rows);
}

std::string title(const TopOptions& options, std::size_t sessions) {
    return "meniscus top  " + options.server.address + "  " + std::to_string(sessions) + " sessions  (q: quit)\n\n";
}

void watch_sessions(const TopOptions& options) {
    Terminal terminal;
    client::Client client = options.server.connect();
    FrameRates rates;
    do {
        try {
            const auto rows = rates.update(client.sessions(), std::chrono::steady_clock::now());
            terminal.draw(title(options, rows.size()) + session_table(rows));
        } catch (const client::ServerError& error) {  // it may come back
            terminal.draw(title(options, 0) + error.what() + "\n");
        }
    } while (!terminal.wait_for_end(options.interval));
}

}  // namespace

void add_top(CLI::App& app) {
    auto options = std::make_shared<TopOptions>();
    CLI::App& command =
        *app.add_subcommand("top", "Watch a server's sessions: frames per second, latency, sizes, drops");
    options->server.add_to(command, "Whose")->required();
    add_seconds(command, "--interval", options->interval, "Seconds from one look to the next")
        ->check(number_range(0.1, 3600.0))
        ->default_str("1");
    command.add_flag("--once", options->once, "Print one table, as is done when the output is no terminal");
    add_examples(command, {"meniscus top --server localhost", "meniscus top --server localhost --once"});
    command.callback([options] {
        if (options->once || ::isatty(STDOUT_FILENO) == 0)
            print_once(*options);
        else
            watch_sessions(*options);
    });
}

}  // namespace meniscus::cli
