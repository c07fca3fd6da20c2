#include <malloc.h>

#include <csignal>
#include <cstdlib>

#include "cli/commands/command_line.hpp"

int main(int argc, char** argv) {
    // An error is one line, and gRPC's own messages would stand before it.
    setenv("GRPC_VERBOSITY", "NONE", 0);
    // Every frame takes megabytes and gives them back. Those that are kept need not be cleared for the next one.
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
    mallopt(M_TRIM_THRESHOLD, 256 << 20);
    // A reader that goes away, and a limit on the size of files, are errors of the write. Of standard error:
    // listener.hpp.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    return meniscus::cli::run(argc, argv);
}
