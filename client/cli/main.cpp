#include <csignal>
#include <cstdlib>

#include "cli/command_line.hpp"

int main(int argc, char** argv) {
    // What goes wrong is one line, which gRPC's own messages would stand before.
    setenv("GRPC_VERBOSITY", "NONE", 0);
    // A reader that goes away, and a limit on the size of files, are errors of the write.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    return meniscus::cli::run(argc, argv);
}
