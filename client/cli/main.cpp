#include "cli/command_line.hpp"

int main(int argc, char** argv) {
    return meniscus::cli::run(argc, argv);
}
