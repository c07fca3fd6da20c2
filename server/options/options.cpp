#include "options/options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <system_error>

#include "address/loopback.hpp"
#include "meniscus/names.hpp"
#include "meniscus/reconstructor.hpp"
#include "options/settings_sources.hpp"
#include "process/available_memory.hpp"

namespace meniscus::server {

namespace {

/// Half of the memory that there is.
std::size_t default_memory_limit() {
    return available_memory() / 2;
}

/// A full chunk, and what is around it.
constexpr std::size_t min_message_bytes = chunk_bytes + 1024;
/// What gRPC can be told.
constexpr std::size_t max_message_bytes = std::numeric_limits<int>::max();

/// What one caller may have where nothing else is said: others find room beside it.
NameShares default_shares(const Limits& limits) {
    const auto most_of = [](std::uint32_t limit) { return limit > 1 ? limit - std::max(limit / 8, 1U) : limit; };
    return {.sessions = most_of(limits.sessions),
            .watchers = most_of(limits.watchers_per_session),
            .formats = most_of(limits.formats_per_session),
            .bytes_in_flight = limits.bytes_in_flight - limits.bytes_in_flight / 4};
}

std::chrono::milliseconds milliseconds(double seconds) {
    return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::duration<double>(seconds));
}

/// Of a number that may have a unit, before the unit is looked at: CLI11 takes "-5" for a large number, and one that is
/// too large for the largest.
CLI::Validator whole_number() {
    return {[](std::string& text) -> std::string {
                std::uint64_t number = 0;
                const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
                if (error == std::errc::result_out_of_range)
                    return fmt::format("{} is more than {}", text, std::numeric_limits<std::uint64_t>::max());
                return error == std::errc{} ? "" : fmt::format("{} is no number from 0 on", text);
            },
            "", "whole number"};
}

/// None for anything else, such as "nan", which CLI11's own range takes.
std::optional<double> number_up_to(double most, const std::string& text) {
    double number = 0.0;
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error == std::errc{} && rest == text.data() + text.size() && number >= 0.0 && number <= most) return number;
    return std::nullopt;
}

CLI::Validator up_to(double most) {
    return {[most](std::string& text) -> std::string {
                return number_up_to(most, text) ? "" : fmt::format("{} is no number from 0 to {}", text, most);
            },
            "", "number"};
}

/// The server counts milliseconds. Less than one would be 0, which is no limit.
CLI::Validator seconds_up_to(double most) {
    return {[most](std::string& text) -> std::string {
                constexpr double least = 0.001;
                const auto seconds = number_up_to(most, text);
                if (seconds && (*seconds == 0.0 || *seconds >= least)) return "";
                return fmt::format("{} is no number of seconds: 0, or from {} to {}", text, least, most);
            },
            "", "seconds"};
}

/// For an address that may be none.
constexpr const char* off = "off";

/// So that a file with an empty value, and what --print-config makes of it, mean the same.
CLI::Validator off_for_nothing() {
    return {[](std::string& text) -> std::string {
                if (text.empty()) text = off;
                return "";
            },
            "", "off for nothing"};
}

/// The viewer of who tries a server out on one machine. Empty where others could reach it, or where nobody asked for
/// TCP.
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

}  // namespace

std::optional<EarlyExit> parse_command_line(int argc, const char* const* argv, CommandLine& command_line) {
    ServerOptions& server = command_line.server;
    server.limits.particles_per_frame = 100'000'000;
    server.limits.bytes_per_session = default_memory_limit();
    server.limits.bytes_in_flight = default_memory_limit();
    server.limits.least_pace.bytes_per_second = 100'000;
    double idle_seconds = 3600.0;
    double reader_pause_seconds = 60.0;
    double frame_seconds = std::chrono::duration<double>(server.limits.frame_time).count();
    double upload_seconds = 30.0;
    double orphan_seconds = 120.0;
    double idle_buffers_seconds = 60.0;
    server.limits.total_bytes = default_memory_limit();
    OwnShares shares;
    double max_age_seconds = 0.0;
    double grace_seconds = std::chrono::duration<double>(server.shutdown_grace).count();

    CLI::App app{"meniscusd: adaptive surfaces of simulated fluid particles, live, over gRPC", "meniscusd"};
    app.option_defaults()->always_capture_default();
    app.set_version_flag("--version", std::string(version()));
    std::string config;
    bool print_config = false;
    app.add_option("--config", config, "File of settings; also MENISCUS_CONFIG")
        ->envname("MENISCUS_CONFIG")
        ->configurable(false)
        ->type_name("FILE");
    app.add_flag("--print-config", print_config, "Print the settings in effect, as such a file, and end")
        ->configurable(false);
    app.add_flag("--check-config", command_line.check_config, "Say whether the settings can be used, and end")
        ->configurable(false);
    app.add_option("--listen", server.listen,
                   "HOST:PORT (port 0: a free one, which is logged) or unix:PATH (for this user alone)");
    app.add_option("--tls-cert", server.tls.certificate, "Certificate chain for TLS, PEM")->type_name("FILE");
    app.add_option("--tls-key", server.tls.key, "Its key, PEM")->type_name("FILE");
    app.add_option("--tls-client-ca", server.tls.client_ca,
                   "Mutual TLS: clients need a certificate of one of these, PEM")
        ->type_name("FILE");
    app.add_option("--tokens", server.tokens,
                   "Lines ROLE NAME TOKEN, the role being uploader, watcher or admin: calls need one of these tokens")
        ->type_name("FILE");
    app.add_flag("--insecure", server.insecure, "Let other machines connect without TLS, also to --http");
    const CLI::Option* http =
        app.add_option("--http", server.http,
                       "HOST:PORT (port 0: a free one, which is logged) of the viewer, /metrics, /healthz and /readyz; "
                       "off: none. Default: where --listen is TCP on loopback, its port 9464, or a free one where that "
                       "is taken; otherwise off")
            ->transform(off_for_nothing())
            ->type_name("HOST:PORT")
            ->default_str("");
    app.add_option("--probes", server.probes,
                   "HOST:PORT of /metrics, /healthz and /readyz alone, always without TLS, also for other machines: "
                   "they tell numbers only");
    app.add_option("--trusted-proxies", server.trusted_proxies,
                   "Addresses and networks, as 192.0.2.7,10.0.0.0/8, of proxies through which others come: limits for "
                   "each peer address do not hold for them, nor for loopback and Unix sockets")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("LIST")
        ->default_str("");
    app.add_option("--web-origin", server.web_origins,
                   "Page, as https://example.org, that may call over the HTTP port; those of this machine may")
        ->allow_extra_args(false)
        ->type_name("ORIGIN")
        ->default_str("");
    app.add_option("--web-frame-ancestors", server.web_frame_ancestors,
                   "Pages, as https://example.org,https://example.org:8443, that may show the viewer in a frame")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("ORIGINS")
        ->default_str("");
    app.add_flag("--reflection", server.standard_services.reflection,
                 "Let clients ask for the contract, as grpcurl does");
    app.add_flag("--channelz", server.standard_services.channelz, "Let clients ask for connections and their traffic");

    app.add_option_function<std::string>(
           "--backend",
           [&server](const std::string& name) { server.backend.backend = by_name<Backend>(name, "backend"); },
           listed(names<Backend>))
        ->type_name("NAME")
        ->default_str(std::string(name_of(server.backend.backend)));
    app.add_option(
           "--devices", server.devices,
           "GPUs to use, as 0,1: each session on the one with the most free memory. Default: all that can be used")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::NonNegativeNumber)
        ->type_name("LIST")
        ->default_str("");
    app.add_option("--threads", server.backend.threads, "Worker threads; 0: one per processor")
        ->check(CLI::Range(0U, max_threads));
    app.add_option("--max-sessions", server.limits.sessions, "Sessions at a time; 0: no limit");
    app.add_option("--max-watchers", server.limits.watchers_per_session, "Watchers of one session; 0: no limit");
    app.add_option("--max-formats", server.limits.formats_per_session,
                   "Formats of the meshes and numbers of particles that the watchers of one session wish for, of which "
                   "one caller has all but an eighth; 0: no limit");
    app.add_option(
        "--max-connections", server.limits.connections,
        "Connections to the gRPC port, as far as the limit of descriptors (ulimit -n) is enough; 0: as many");
    app.add_option("--max-connections-per-peer", server.limits.connections_per_peer,
                   "Connections from one address to one port, but for loopback, Unix sockets and --trusted-proxies; 0: "
                   "no limit");
    const auto share_of = [](const char* what, const char* rest) {
        return fmt::format("{} of one token's name, or without tokens of one peer address{}", what, rest);
    };
    app.add_option("--max-sessions-per-name", shares.sessions,
                   share_of("Sessions", "; 0: no limit. Default: all but an eighth of --max-sessions"))
        ->default_str("");
    app.add_option("--max-watchers-per-name", shares.watchers,
                   share_of("Watchers of one session", "; 0: no limit. Default: all but an eighth of --max-watchers"))
        ->default_str("");
    app.add_option("--max-recording-readers", server.limits.recording_readers,
                   "Calls that read recordings at a time; 0: no limit");
    app.add_option("--max-reader-pause", reader_pause_seconds,
                   "Seconds that a client that reads a recording may take for one message; 0: no limit")
        ->check(seconds_up_to(1e7));
    app.add_option("--max-particles", server.limits.particles_per_frame, "Particles of one frame; 0: no limit")
        ->check(whole_number());
    app.add_option(
           "--max-frame-work", server.limits.work_per_frame,
           "Times the work that as many evenly spread particles are at that cell size: a frame that is estimated "
           "to be more is refused; 0: no limit")
        ->check(up_to(1e9));
    app.add_option("--max-frame-seconds", frame_seconds,
                   "Seconds for which one frame may have the device, after which it is stopped; 0: no limit")
        ->check(seconds_up_to(1e7));
    app.add_option("--max-bytes-in-flight", server.limits.bytes_in_flight,
                   "Frames that wait to be reconstructed, over all sessions; 0: no limit. Default: half of the "
                   "machine's memory, or of the container's")
        ->transform(CLI::AsSizeValue(false))
        ->transform(whole_number())
        ->type_name("BYTES");
    app.add_option("--max-frames-per-second", server.limits.frames_per_second, "Frames of one session; 0: no limit");
    app.add_option("--max-frames-per-second-per-name", shares.frames_per_second,
                   share_of("Frames over all sessions", "; 0, the default: no limit"))
        ->default_str("");
    app.add_option("--max-bytes-in-flight-per-name", shares.bytes_in_flight,
                   share_of("Frames that wait to be reconstructed",
                            "; 0: no limit. Default: three quarters of --max-bytes-in-flight"))
        ->transform(CLI::AsSizeValue(false))
        ->transform(whole_number())
        ->type_name("BYTES")
        ->default_str("");
    app.add_option("--max-chunks", server.limits.chunks_per_frame, "Chunk messages of one frame; 0: no limit");
    app.add_option("--max-message-bytes", server.limits.message_bytes, "Size of one message, as 4M")
        ->transform(CLI::AsSizeValue(false))
        ->transform(whole_number())
        ->check(CLI::Range(min_message_bytes, max_message_bytes))
        ->type_name("BYTES");
    app.add_option("--max-upload-seconds", upload_seconds,
                   "Seconds in which a frame must have arrived, unless it comes with --min-upload-rate; 0: no limit")
        ->check(seconds_up_to(1e7));
    app.add_option("--min-upload-rate", server.limits.least_pace.bytes_per_second,
                   "Bytes a second with which a frame must come after --max-upload-seconds; 0: none may take longer")
        ->transform(CLI::AsSizeValue(false))
        ->transform(whole_number())
        ->type_name("BYTES");
    app.add_option(
           "--max-idle", idle_seconds,
           "Seconds that a stream, or a session without streams, watchers and calls, is kept without use; 0: no limit")
        ->check(seconds_up_to(1e7));
    app.add_option("--orphan-seconds", orphan_seconds,
                   "Seconds that a session is kept whose simulator has vanished without a word, unless it is watched "
                   "or resumed; 0: as any other")
        ->check(seconds_up_to(1e7));
    app.add_option("--memory-limit", server.limits.bytes_per_session,
                   "Memory of one session's reconstruction, as 4G or 500M; 0: no limit. Default: half of the "
                   "machine's, or of the container's")
        ->transform(CLI::AsSizeValue(false))
        ->transform(whole_number())
        ->type_name("BYTES");
    app.add_option("--total-memory-limit", server.limits.total_bytes,
                   "Memory of all sessions' reconstructions, of encoding, and of what is kept of frames; 0: no limit. "
                   "Default: half of the machine's, or of the container's")
        ->transform(CLI::AsSizeValue(false))
        ->transform(whole_number())
        ->type_name("BYTES");
    app.add_option("--total-device-memory-limit", server.limits.total_device_bytes,
                   "Memory of all sessions' reconstructions on one GPU; 0: no limit")
        ->transform(CLI::AsSizeValue(false))
        ->transform(whole_number())
        ->type_name("BYTES");
    app.add_option(
           "--idle-buffers", idle_buffers_seconds,
           "Seconds after which a session without frames gives the memory of its reconstruction back, and takes "
           "it again when it needs it; 0: only where others need it")
        ->check(seconds_up_to(1e7));
    app.add_option("--device-memory-limit", server.limits.device_bytes_per_session,
                   "Memory of one session's reconstruction on its GPU; 0: no limit")
        ->transform(CLI::AsSizeValue(false))
        ->transform(whole_number())
        ->type_name("BYTES");
    app.add_option("--shutdown-grace", grace_seconds,
                   "Seconds that clients get after SIGTERM to take the frames they are owed")
        ->check(seconds_up_to(3600.0));
    app.add_option("--record", server.recording.directory,
                   "Folder to keep every session's particles and meshes in; see meniscus recordings, replay, convert")
        ->type_name("DIR")
        ->default_str("");
    app.add_option("--record-limit", server.recording.limit,
                   "Bytes of all recordings in that folder, as 100G; 0: no limit. Nothing is deleted: recording stops")
        ->transform(CLI::AsSizeValue(false))
        ->transform(whole_number())
        ->type_name("BYTES");
    app.add_option("--record-attribute-bits", server.recording.attribute_bits,
                   "Bits per component of the float32 attributes in recorded meshes, 1 to 16; 0: exact")
        ->check(CLI::Range(0, max_attribute_bits));
    app.add_option("--record-min-frames", server.recording.retention.min_frames,
                   "A recording with fewer frames is deleted when it is closed; 0: none is")
        ->check(whole_number());
    app.add_option("--record-max-age", max_age_seconds,
                   "Seconds after which a recording to which nothing more was written is deleted, as 2592000 for 30 "
                   "days; 0: none is")
        ->check(seconds_up_to(1e9));
    app.add_option_function<std::string>(
           "--log-level",
           [&](const std::string& name) { command_line.log_level = by_name<LogLevel>(name, "--log-level"); },
           listed(names<LogLevel>))
        ->type_name("NAME")
        ->default_str(std::string(name_of(command_line.log_level)));
    app.add_option_function<std::string>(
           "--log-format",
           [&](const std::string& name) { command_line.log_format = by_name<LogFormat>(name, "--log-format"); },
           "text, or json: one object a line")
        ->type_name("NAME")
        ->default_str(std::string(name_of(command_line.log_format)));

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
        const std::string message = error.what();
        return refuse({message.substr(0, message.find('\n')) + " (see meniscusd --help)"});
    }
    if (http->count() == 0) {
        server.http = default_http(server.listen);
        server.http_is_default = true;
    } else if (server.http == off) {
        server.http.clear();
    }
    if (print_config) return EarlyExit{.text = settings_file(app), .code = 0};
    server.limits.idle_time = milliseconds(idle_seconds);
    server.limits.reader_patience = milliseconds(reader_pause_seconds);
    server.limits.frame_time = milliseconds(frame_seconds);
    server.limits.least_pace.time = milliseconds(upload_seconds);
    server.limits.orphan_time = milliseconds(orphan_seconds);
    server.limits.idle_buffers_time = milliseconds(idle_buffers_seconds);
    server.limits.per_name = shares.over(default_shares(server.limits));
    server.recording.retention.max_age = milliseconds(max_age_seconds);
    server.shutdown_grace = milliseconds(grace_seconds);
    return std::nullopt;
}

}  // namespace meniscus::server
