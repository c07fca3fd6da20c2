// The run of a program of benchmarks, by its arguments.
#pragma once

#include <filesystem>

namespace CLI {
class App;
}

namespace meniscus::benchmarks {

/// Runs the subcommand that is asked for, and returns the exit code: 0, 1 after a failure, 2 for wrong arguments, 77
/// where there is no GPU for a command that needs one.
int run_program(CLI::App& app, int argc, char** argv);

/// The arguments of run_program().
char* const* program_arguments();
/// The file that runs this program anew: that by which it was called. /proc/self/exe is the loader where a script calls
/// it with one of its own.
std::filesystem::path program_path();

}  // namespace meniscus::benchmarks
