// A program in a process group of its own, with a limit of time.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace meniscus::benchmarks {

struct Command {
    std::vector<std::string> words;                                  ///< the program's path first
    std::vector<std::pair<std::string, std::string>> environment{};  ///< beside that of this process
    bool ends_on_signals = true;                                     ///< else only its time ends it
};

struct CommandEnd {
    int exit_code = 0;  ///< 128 and the signal's number if one has ended it
    bool is_cut_off = false;
    double seconds = 0.0;
    std::string last_line;  ///< of its output
};

/// Runs it to its end, or ends all of its group once the seconds are up, or SIGTERM, SIGINT or SIGHUP has come. Its
/// output goes to the file `log`. Throws std::runtime_error if it cannot be run.
CommandEnd run_command(const Command& command, const std::string& log, double seconds);

/// From here on those signals end the child of run_command(), and this process goes on.
void end_commands_on_signals();
/// Whether one has come.
bool is_asked_to_end();

}  // namespace meniscus::benchmarks
