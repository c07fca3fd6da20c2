#include "options/options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "address/loopback.hpp"
#include "meniscus/near_name.hpp"
#include "meniscus/reconstructor.hpp"
#include "options/flags.hpp"
#include "options/settings_sources.hpp"
#include "process/available_memory.hpp"

namespace meniscus::server {

namespace {

/// Half of the memory that there is.
std::size_t default_memory_limit() {
    return available_memory() / 2;
}

/// The limits of a server for which nobody has set any.
Limits default_limits() {
    return {.particles_per_frame = 100'000'000,
            .total_bytes = default_memory_limit(),
            .idle_buffers_time = std::chrono::minutes(1),
            .bytes_in_flight = default_memory_limit(),
            .least_pace = {.time = std::chrono::seconds(30), .bytes_per_second = 100'000},
            .idle_time = std::chrono::hours(1),
            .orphan_time = std::chrono::minutes(2)};
}

/// The value for no address, of an option that allows it.
constexpr const char* off = "off";

/// So that a file with an empty value, and what --print-config makes of it, mean the same.
CLI::Validator off_for_nothing() {
    return {[](std::string& text) -> std::string {
                if (text.empty()) text = off;
                return "";
            },
            "", "off for nothing"};
}

/// The viewer where somebody tries a server out on one machine. Empty where others could reach it, or where nobody
/// asked for TCP.
std::string default_http(const std::string& listen) {
    constexpr const char* port = ":9464";
    if (listen.starts_with("unix:") || !address::is_loopback(listen)) return {};
    return listen.substr(0, listen.rfind(':')) + port;
}

/// A line for each; of a message its first line: CLI11 adds a hint on a second one.
EarlyExit refuse(const std::vector<std::string>& problems) {
    EarlyExit exit{.text = {}, .code = 2};
    for (const std::string& problem : problems)
        exit.text += fmt::format("meniscusd: {}\n", problem.substr(0, problem.find('\n')));
    return exit;
}

/// What of the command line is not known, in its order: options, and if there are none, what else was not expected.
std::vector<std::string> unknown_arguments(const CLI::App& app) {
    const std::vector<std::string> left = app.remaining();
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options())
        names.insert(names.end(), option->get_lnames().begin(), option->get_lnames().end());
    std::vector<std::string> problems;
    for (const std::string& argument : left) {
        const std::size_t begin = argument.find_first_not_of('-');
        if (begin == 0 || begin == std::string::npos) continue;
        const std::string option = argument.substr(0, argument.find('='));
        const std::string near = near_name(std::string_view(option).substr(begin), names);
        problems.push_back(fmt::format("unknown option {}{}", option,
                                       suggestion(near.empty() ? "" : "--" + near, "meniscusd --help")));
    }
    if (problems.empty())
        for (const std::string& argument : left)
            problems.push_back(fmt::format("unexpected argument '{}'; see meniscusd --help", argument));
    return problems;
}

/// The requests on the command line beside the settings.
struct Requests {
    std::string config;
    bool print_config = false;
};

void add_requests(CLI::App& app, Requests& requests, CommandLine& command_line) {
    app.set_version_flag("--version", std::string(version()));
    app.add_option("--config", requests.config, "File of settings; also MENISCUS_CONFIG")
        ->envname("MENISCUS_CONFIG")
        ->configurable(false)
        ->type_name("FILE");
    app.add_flag("--print-config", requests.print_config, "Print the settings in effect, as such a file, and end")
        ->configurable(false);
    app.add_flag("--check-config", command_line.check_config, "Say whether the settings can be used, and end")
        ->configurable(false);
}

/// Reads the settings from the command line, then from the environment, then from a file.
std::optional<EarlyExit> read_settings(int argc, const char* const* argv, CLI::App& app, const std::string& config) {
    try {
        app.parse(argc, argv);
        std::vector<std::string> problems = apply_settings(environment_settings(::environ), app);
        if (!config.empty())
            std::ranges::move(apply_settings(file_settings(config), app), std::back_inserter(problems));
        if (!problems.empty()) return refuse(problems);
    } catch (const CLI::CallForHelp&) {
        return EarlyExit{.text = app.help(), .code = 0};
    } catch (const CLI::CallForVersion&) {
        return EarlyExit{.text = fmt::format("meniscusd {}\n", version()), .code = 0};
    } catch (const CLI::ParseError& error) {
        // Other errors may follow from what is not known.
        if (const std::vector<std::string> problems = unknown_arguments(app); !problems.empty())
            return refuse(problems);
        const std::string message = error.what();
        return refuse({message.substr(0, message.find('\n')) + " (see meniscusd --help)"});
    }
    return std::nullopt;
}

void set_http(bool is_given, ServerOptions& server) {
    if (!is_given) {
        server.http = default_http(server.listen);
        server.http_is_default = true;
    } else if (server.http == off) {
        server.http.clear();
    }
}

}  // namespace

std::optional<EarlyExit> parse_command_line(int argc, const char* const* argv, CommandLine& command_line) {
    command_line.server.limits = default_limits();
    CLI::App app{"meniscusd: adaptive surfaces of simulated fluid particles, live, over gRPC", "meniscusd"};
    app.option_defaults()->always_capture_default();
    Requests requests;
    add_requests(app, requests, command_line);
    add_flags(app, command_line);
    const CLI::Option* http = app.get_option("--http")->transform(off_for_nothing());
    if (auto exit = read_settings(argc, argv, app, requests.config)) return exit;
    set_http(http->count() != 0, command_line.server);
    if (requests.print_config) return EarlyExit{.text = settings_file(app), .code = 0};
    set_defaults_that_follow(app, command_line);
    return std::nullopt;
}

}  // namespace meniscus::server
