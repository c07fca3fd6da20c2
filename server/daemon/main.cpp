// meniscusd.
#include <google/protobuf/stubs/logging.h>
#include <grpc/support/log.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "connections/descriptors.hpp"
#include "connections/listen_address.hpp"
#include "daemon/server.hpp"
#include "meniscus/error.hpp"
#include "options/options.hpp"
#include "process/exit_deadline.hpp"
#include "process/freed_memory.hpp"
#include "process/line_limit.hpp"
#include "process/log.hpp"
#include "process/unavailable.hpp"

namespace {

/// How often files of certificates and tokens are read again.
constexpr timespec reload_period{.tv_sec = 10, .tv_nsec = 0};

/// Blocked before any thread starts, so that only wait_for_stop() sees them.
sigset_t block_signals() {
    sigset_t signals;
    sigemptyset(&signals);
    for (const int signal : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&signals, signal);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    return signals;
}

/// Waits for SIGTERM or SIGINT and returns it. Meanwhile reloads certificates and tokens at SIGHUP, and periodically.
int wait_for_stop(const sigset_t& signals, meniscus::server::Server& server) {
    for (;;) {
        const int signal = sigtimedwait(&signals, nullptr, &reload_period);
        if (signal == SIGTERM || signal == SIGINT) return signal;
        if (signal == SIGHUP) spdlog::info("{}: reading certificates and tokens again", strsignal(signal));
        if (signal == SIGHUP || errno == EAGAIN) server.reload();
    }
}

/// Does the work of --check-config.
int check(const meniscus::server::ServerOptions& options) {
    const std::vector<std::string> problems = meniscus::server::problems_of(options);
    for (const std::string& problem : problems) std::fprintf(stderr, "meniscusd: %s\n", problem.c_str());
    if (problems.empty()) std::puts("the settings can be used");
    return problems.empty() ? 0 : 2;
}

/// Before the server listens, gRPC's messages matter to developers alone.
void log_grpc_for_debugging(gpr_log_func_args* message) {
    spdlog::debug("gRPC: {}", message->message);
}

/// Once the server listens, an operator wants to know which handshakes fail. But any stranger can make them fail, again
/// and again.
void log_grpc(gpr_log_func_args* message) {
    static meniscus::server::LineLimit warnings(10);
    const std::string_view text(message->message);
    // A refusal, which its client receives.
    const bool is_refusal = text.find("ompression algorithm") != std::string_view::npos;
    const auto left = message->severity == GPR_LOG_SEVERITY_ERROR && !is_refusal ? warnings.pass() : std::nullopt;
    spdlog::log(left ? spdlog::level::warn : spdlog::level::debug, "gRPC: {}{}", text,
                meniscus::server::left_out(left.value_or(0)));
}

int run(const meniscus::server::CommandLine& command_line) {
    meniscus::server::keep_arrays_out_of_the_heaps();
    const sigset_t signals = block_signals();
    spdlog::set_default_logger(spdlog::stderr_color_mt("meniscusd"));
    meniscus::server::use_log_format(command_line.log_format);
    use_log_level(command_line.log_level);
    spdlog::flush_on(spdlog::level::debug);
    gpr_set_log_function(log_grpc_for_debugging);
    meniscus::server::raise_descriptor_limit();
    // protobuf prints parts of messages that do not parse: text that any sender could put into the log.
    google::protobuf::SetLogHandler(nullptr);

    meniscus::server::ExitDeadline exit_deadline;
    meniscus::server::Server server(command_line.server);
    gpr_set_log_function(log_grpc);
    const meniscus::BackendDescription& backend = server.backend();
    spdlog::info("meniscusd {} listening on {}, backend {} on {}: {}", meniscus::version(), server.address(),
                 backend.name, backend.device, backend.reason);
    if (!server.http_address().empty())
        spdlog::info("viewer, metrics and probes at {}://{}", command_line.server.tls.any() ? "https" : "http",
                     server.http_address());
    if (!server.probes_address().empty()) spdlog::info("metrics and probes at http://{}", server.probes_address());
    const int signal = wait_for_stop(signals, server);
    exit_deadline.start(command_line.server.shutdown_grace);
    spdlog::info("{}: finishing the frames in flight", strsignal(signal));
    server.shutdown();
    spdlog::info("stopped");
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        meniscus::server::CommandLine command_line;
        if (const auto exit = meniscus::server::parse_command_line(argc, argv, command_line)) {
            std::fputs(exit->text.c_str(), exit->code == 0 ? stdout : stderr);
            return exit->code;
        }
        // Sockets and files are for this user alone.
        umask(077);
        return command_line.check_config ? check(command_line.server) : run(command_line);
    } catch (const meniscus::InvalidInput& error) {
        std::fprintf(stderr, "meniscusd: %s\n", error.what());
        return 2;
    } catch (const meniscus::server::Unavailable& error) {
        std::fprintf(stderr, "meniscusd: %s\n", error.what());
        return 1;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "meniscusd: internal error: %s\n", error.what());
        return 1;
    }
}
