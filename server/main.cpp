// meniscusd.
#include <google/protobuf/stubs/logging.h>
#include <grpc/support/log.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>

#include "meniscus/error.hpp"
#include "options.hpp"
#include "server.hpp"

namespace {

/// Blocked before any thread starts, so that only wait_for_stop() sees them.
sigset_t block_stop_signals() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGTERM);
    sigaddset(&signals, SIGINT);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    return signals;
}

int wait_for_stop(const sigset_t& signals) {
    int signal = 0;
    while (sigwait(&signals, &signal) != 0) {
    }
    return signal;
}

/// gRPC's own messages have no reader but a developer's.
void log_grpc(gpr_log_func_args* message) {
    spdlog::debug("gRPC: {}", message->message);
}

int run(const meniscus::server::CommandLine& command_line) {
    const sigset_t signals = block_stop_signals();
    spdlog::set_default_logger(spdlog::stderr_color_mt("meniscusd"));
    spdlog::set_pattern("%Y-%m-%dT%H:%M:%S.%e%z %l %v");
    spdlog::set_level(command_line.log_level);
    spdlog::flush_on(spdlog::level::debug);
    gpr_set_log_function(log_grpc);
    // What protobuf would print of messages that do not parse is their senders' to choose.
    google::protobuf::SetLogHandler(nullptr);

    meniscus::server::Server server(command_line.server);
    const meniscus::BackendDescription& backend = server.backend();
    spdlog::info("meniscusd {} listening on {}, backend {} on {}: {}", meniscus::version(), server.address(), backend.name,
                 backend.device, backend.reason);
    const int signal = wait_for_stop(signals);
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
        return run(command_line);
    } catch (const meniscus::InvalidInput& error) {
        std::fprintf(stderr, "meniscusd: %s\n", error.what());
        return 2;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "meniscusd: internal error: %s\n", error.what());
        return 1;
    }
}
