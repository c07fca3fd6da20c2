// Runs the command line as a user does.
#pragma once

#include <string>
#include <vector>

namespace meniscus::test {

struct ProcessResult {
    int exit_code = -1;  ///< -1: ended by a signal
    std::string out;
    std::string err;
    double processor_seconds = 0.0;
    double peak_megabytes = 0.0;  ///< of memory; not less than this process had when it was started
};

/// Where a process reads and writes, if not as this one does.
struct Redirection {
    std::string in = {};  ///< the file that is its standard input; empty: as this process has it
    int out = -1;         ///< the descriptor that is its standard output; -1: ProcessResult::out
    int err = -1;         ///< likewise
};

/// Runs `program` with these arguments and waits for its end.
ProcessResult run_process(const std::string& program, const std::vector<std::string>& arguments,
                          const Redirection& redirection = {});

}  // namespace meniscus::test
