#include "options.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <map>

namespace meniscus::server {

namespace {

/// Half of this machine's memory.
std::size_t default_memory_limit() {
    const long pages = ::sysconf(_SC_PHYS_PAGES);
    const long page_bytes = ::sysconf(_SC_PAGE_SIZE);
    if (pages <= 0 || page_bytes <= 0) return 0;
    return static_cast<std::size_t>(pages) / 2 * static_cast<std::size_t>(page_bytes);
}

/// The first line: CLI11 adds a hint on a second one.
std::string first_line(const std::string& text) {
    return text.substr(0, text.find('\n'));
}

}  // namespace

std::optional<EarlyExit> parse_command_line(int argc, const char* const* argv, CommandLine& command_line) {
    ServerOptions& server = command_line.server;
    server.limits.particles_per_frame = 100'000'000;
    server.limits.bytes_per_session = default_memory_limit();
    double grace_seconds = std::chrono::duration<double>(server.shutdown_grace).count();

    CLI::App app{"meniscusd: adaptive surfaces of simulated fluid particles, live, over gRPC", "meniscusd"};
    app.option_defaults()->always_capture_default();
    app.set_version_flag("--version", std::string(version()));
    app.add_option("--listen", server.listen, "HOST:PORT (port 0: a free one, which is logged) or unix:PATH");

    app.add_option_function<std::string>(
           "--backend", [&server](const std::string& name) { server.backend.backend = backend_by_name(name); },
           "auto, cpu or cuda")
        ->type_name("NAME")
        ->default_str("auto");
    app.add_option("--devices", server.devices,
                   "GPUs to use, as 0,1: each session on the one with the most free memory. Default: all that can be used")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::NonNegativeNumber)
        ->type_name("LIST")
        ->default_str("");
    app.add_option("--threads", server.backend.threads, "Worker threads; 0: one per processor")
        ->check(CLI::Range(0U, 1024U));
    app.add_option("--max-sessions", server.limits.sessions, "Sessions at a time; 0: no limit");
    app.add_option("--max-watchers", server.limits.watchers_per_session, "Watchers of one session; 0: no limit");
    app.add_option("--max-particles", server.limits.particles_per_frame, "Particles of one frame; 0: no limit");
    app.add_option("--memory-limit", server.limits.bytes_per_session,
                   "Memory of one session's reconstruction, as 4G or 500M; 0: no limit. Default: half of the machine's")
        ->transform(CLI::AsSizeValue(false))
        ->type_name("BYTES");
    app.add_option("--device-memory-limit", server.limits.device_bytes_per_session,
                   "Memory of one session's reconstruction on its GPU; 0: no limit")
        ->transform(CLI::AsSizeValue(false))
        ->type_name("BYTES");
    app.add_option("--shutdown-grace", grace_seconds,
                   "Seconds that clients get after SIGTERM to take the frames they are owed")
        ->check(CLI::Range(0.0, 3600.0));
    const std::map<std::string, spdlog::level::level_enum> levels{{"debug", spdlog::level::debug},
                                                                  {"info", spdlog::level::info},
                                                                  {"warning", spdlog::level::warn},
                                                                  {"error", spdlog::level::err},
                                                                  {"off", spdlog::level::off}};
    app.add_option("--log-level", command_line.log_level, "debug, info, warning, error or off")
        ->transform(CLI::CheckedTransformer(levels).description(""))
        ->type_name("NAME")
        ->default_str("info");

    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        return EarlyExit{.text = app.help(), .code = 0};
    } catch (const CLI::CallForVersion&) {
        return EarlyExit{.text = fmt::format("meniscusd {}\n", version()), .code = 0};
    } catch (const CLI::ParseError& error) {
        return EarlyExit{.text = fmt::format("meniscusd: {} (see meniscusd --help)\n", first_line(error.what())), .code = 2};
    }
    server.shutdown_grace =
        std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::duration<double>(grace_seconds));
    return std::nullopt;
}

}  // namespace meniscus::server
