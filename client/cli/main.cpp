#include <cstdlib>

#include "cli/command_line.hpp"

int main(int argc, char** argv) {
    // What goes wrong is one line, which gRPC's own messages would stand before.
    setenv("GRPC_VERBOSITY", "NONE", 0);
    return meniscus::cli::run(argc, argv);
}
